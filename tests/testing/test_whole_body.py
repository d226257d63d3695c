from __future__ import annotations

import math
from typing import Any

import msgspec
import pytest

from overreach.arm.chain import Chain
from overreach.arm.mount import Mount
from overreach.baselines.weighted import Weighted
from overreach.law.body import Planner, WholeBody
from overreach.model.model import Model
from overreach.model.planar import planar
from overreach.plugs import law_names, load_law
from overreach.testing.whole_body import check_whole_body
from overreach.types import HandTwist, Plan, Twist
from overreach.verdicts import Verdict


@pytest.mark.parametrize("mount", [Mount(), Mount(0.15, -0.05, 0.2)], ids=["centred", "off"])
@pytest.mark.parametrize("name", law_names(planar()))
def test_every_whole_body_conforms(name: str, mount: Mount) -> None:
    """Every law and every rival keeps the promises of a whole body, wherever the shoulder is."""
    check_whole_body(load_law(name), planar(mount=mount))


class Broken(WholeBody, frozen=True):
    """The pseudo-inverse but for what is changed in its plan."""

    name = "broken"
    closes_residual = False
    split: dict[str, Any] = {}
    joints: tuple[float, ...] | None = None

    def planner(self, model: Model) -> Planner:
        inner = Weighted().planner(model)

        def plan(chain: Chain, u: HandTwist, base: Twist) -> Plan:
            right = inner(chain, u, base)
            return Plan(msgspec.structs.replace(right.split, **self.split), self.joints or right.joints)

        return plan


class Closing(Broken, frozen=True):
    """The same, with the claim to be exact."""

    closes_residual = True


class Drifting(WholeBody, frozen=True):
    """A whole body that remembers."""

    name = "drifting"

    def planner(self, model: Model) -> Planner:
        inner, calls = Weighted().planner(model), 0

        def plan(chain: Chain, u: HandTwist, base: Twist) -> Plan:
            nonlocal calls
            calls += 1
            right = inner(chain, u, base)
            return Plan(msgspec.structs.replace(right.split, mu=min(1.0, calls * 1e-6)), right.joints)

        return plan


@pytest.mark.parametrize(
    ("body", "says"),
    [
        (Broken({"v_b": math.nan}), "cannot be used"),
        (Broken({"scale": 1.5}), "cannot be used"),
        (Broken({"verdict": Verdict.SPEED}), "cannot be used"),
        (Broken({}, (math.inf, 0.0)), "cannot be used"),
        (Broken({"sigma": -0.5}), "sigma is not in"),
        (Broken({"verdict": Verdict.NO_SOLUTION}), "but not still"),
        (Broken({}, (0.1, 0.1)), "off those of the joints"),
        (Closing({"w_b": 0.3}), "off its command"),
        (Broken({"v_b": 0.001}), "moves without a command"),
        (Drifting(), "not a pure function"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_body_that_breaks_a_promise_is_found_out(body: WholeBody, says: str) -> None:
    """The suite can fail: each promise, broken, is named with its case."""
    with pytest.raises(AssertionError, match=says):
        check_whole_body(body, planar())


def test_a_body_that_lacks_a_part_is_found_out() -> None:
    """The suite names what a whole body must have and one has not."""
    body: Any = object()
    with pytest.raises(AssertionError, match="lacks name, frame, closes_residual, planner"):
        check_whole_body(body, planar())
