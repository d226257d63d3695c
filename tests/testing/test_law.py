from __future__ import annotations

import math
from typing import Any

import msgspec
import pytest

from overreach.arm.mount import Mount
from overreach.law.blend import Blend, Smoothstep, Tanh
from overreach.law.laws import Exact, Law, Share
from overreach.model.model import Model
from overreach.model.planar import planar
from overreach.plugs import LAWS, law_plug, load_law, names
from overreach.testing.law import check_law
from overreach.types import Split
from overreach.verdicts import Verdict


@pytest.mark.parametrize("mount", [Mount(), Mount(0.15, -0.05, 0.2)], ids=["centred", "off"])
@pytest.mark.parametrize("name", names(LAWS))
def test_every_law_conforms(name: str, mount: Mount) -> None:
    """Every sharing law there is keeps its promises, wherever the shoulder is."""
    law = load_law(name)
    assert isinstance(law, Law)
    check_law(law, planar(mount=mount))


@pytest.mark.parametrize("blend", [Tanh(), Smoothstep(0.02, 0.3)], ids=["tanh", "smoothstep"])
def test_exact_conforms_with_every_blend(blend: Blend) -> None:
    """The exact law is exact with any blend."""
    check_law(Exact(blend), planar(), seed=1)


class Broken(Law, frozen=True):
    """The exact law but for what is changed in its answer."""

    name = "broken"
    changes: dict[str, Any] = {}

    def bind(self, model: Model) -> Share:
        share = Exact().bind(model)
        return lambda *case: msgspec.structs.replace(share(*case), **self.changes)


class Open(Broken, frozen=True):
    """The same, without the claim to be exact."""

    closes_residual = False


class Drifting(Law, frozen=True):
    """A law that remembers."""

    name = "drifting"

    def bind(self, model: Model) -> Share:
        inner, calls = Exact().bind(model), 0

        def share(l: float, psi: float, u_r: float, u_t: float) -> Split:
            nonlocal calls
            calls += 1
            return msgspec.structs.replace(inner(l, psi, u_r, u_t), mu=min(1.0, calls * 1e-6))

        return share


@pytest.mark.parametrize(
    ("law", "says"),
    [
        (Broken({"v_m": math.nan}), "not finite"),
        (Broken({"mu": 1.5}), "mu is not in"),
        (Broken({"scale": -0.1}), "scale is not in"),
        (Broken({"v_m": 0.01}), "off its command"),
        (Broken({"verdict": Verdict.NO_SOLUTION}), "but not still"),
        (Drifting(), "not a pure function"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_law_that_breaks_a_promise_is_found_out(law: Law, says: str) -> None:
    """The suite can fail: each promise, broken, is named with its case."""
    with pytest.raises(AssertionError, match=says):
        check_law(law, planar())


def test_a_law_that_moves_without_a_command_is_found_out() -> None:
    """The suite finds a law that creeps when nothing is asked for."""
    with pytest.raises(AssertionError, match="moves without a command"):
        check_law(Open({"v_b": 0.001, "v_m": 0.0}), planar())


def test_a_law_that_lacks_a_part_is_found_out() -> None:
    """The suite names what a law must have and one has not."""

    class Partial:
        name, closes_residual = "partial", True

    law: Any = Partial()
    with pytest.raises(AssertionError, match="lacks frame, bind"):
        check_law(law, planar())


def test_every_law_is_a_plug_by_its_own_name() -> None:
    """The name of an entry point is the name that a law has itself."""
    for name in names(LAWS):
        assert law_plug(name).name == name
