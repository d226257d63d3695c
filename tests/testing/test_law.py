from __future__ import annotations

import msgspec
import pytest

from overreach.law.blend import smoothstep, tanh
from overreach.law.laws import Law, exact
from overreach.law.workspace import Mount, Workspace
from overreach.plugs import LAWS, load_law, names
from overreach.testing.law import check_law
from overreach.types import Split, Verdict


@pytest.mark.parametrize("mount", [Mount(), Mount(0.15, -0.05, 0.2)], ids=["centred", "off"])
@pytest.mark.parametrize("name", names(LAWS))
def test_every_law_conforms(name: str, mount: Mount) -> None:
    """Every law there is, ours and the baselines, keeps to the Protocol, wherever the shoulder is."""
    check_law(load_law(name, Workspace(), None, mount))


@pytest.mark.parametrize("blend", [tanh(), smoothstep(0.02, 0.3)], ids=["tanh", "smoothstep"])
def test_exact_conforms_with_every_blend(blend: object) -> None:
    """The exact law is exact with any blend."""
    check_law(load_law("exact", None, blend), seed=1)  # type: ignore[arg-type]  # one list for two makers


class Broken:
    """A law that keeps to the Protocol but for what is changed in its answer."""

    def __init__(self, **changes: object) -> None:
        inner = exact()
        self.name, self.frame, self.closes_residual = "broken", inner.frame, inner.closes_residual
        self.workspace, self.blend, self.mount = inner.workspace, inner.blend, inner.mount
        self._inner: Law = inner
        self._changes = changes

    def split(self, l: float, psi: float, u_r: float, u_t: float) -> Split:
        return msgspec.structs.replace(self._inner.split(l, psi, u_r, u_t), **self._changes)


class Drifting(Broken):
    """A law that remembers."""

    calls = 0

    def split(self, l: float, psi: float, u_r: float, u_t: float) -> Split:
        self.calls += 1
        split = super().split(l, psi, u_r, u_t)
        return msgspec.structs.replace(split, mu=min(1.0, self.calls * 1e-6))


@pytest.mark.parametrize(
    ("law", "says"),
    [
        (Broken(v_m=float("nan")), "not finite"),
        (Broken(mu=1.5), "mu is not in"),
        (Broken(scale=-0.1), "scale is not in"),
        (Broken(v_m=0.01), "off its command"),
        (Broken(verdict=Verdict.NO_SOLUTION), "but not still"),
        (Drifting(), "not a pure function"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_law_that_breaks_the_protocol_is_found_out(law: Law, says: str) -> None:
    """The suite can fail: each promise of the Protocol, broken, is named with its case."""
    with pytest.raises(AssertionError, match=says):
        check_law(law)


def test_a_law_that_moves_without_a_command_is_found_out() -> None:
    """The suite finds a law that creeps when nothing is asked for."""
    law = Broken(v_b=0.001, v_m=0.0)
    law.closes_residual = False
    with pytest.raises(AssertionError, match="moves without a command"):
        check_law(law)


def test_a_law_that_lacks_a_part_is_found_out() -> None:
    """The suite names what the Protocol wants and a law has not."""
    law = Broken()
    del law.blend
    with pytest.raises(AssertionError, match="lacks blend"):
        check_law(law)
