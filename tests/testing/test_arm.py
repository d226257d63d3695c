from __future__ import annotations

from typing import Any

import pytest

from overreach.arm.chain import Arm, Moved, Rest
from overreach.arm.mount import Mount
from overreach.arm.planar import Arm2R, Chain2R
from overreach.model.planar import planar
from overreach.testing.arm import check_arm
from overreach.verdicts import Verdict

ARM = planar().arm
SAMPLES = [ARM.posture(l, psi) for l in (0.45, 0.65, 0.85) for psi in (-0.6, 0.0, 0.6)]


@pytest.mark.parametrize("mount", [Mount(), Mount(0.2, -0.1, 0.3)], ids=["centred", "off"])
@pytest.mark.parametrize("elbow", [1, -1])
def test_two_links_conform(elbow: int, mount: Mount) -> None:
    """The closed form of two links keeps all the promises of an arm, either elbow."""
    own = planar().arm
    assert isinstance(own, Arm2R)
    arm = Arm2R(own.links, own.theta_min, own.theta_max, own.dtheta_max, own.ddtheta_max, elbow)
    check_arm(arm, [arm.posture(l, psi) for l in (0.45, 0.65, 0.85) for psi in (-0.6, 0.0, 0.6)], mount)


class Broken:
    """Two links, but for what is changed in their chain."""

    def __init__(self, **changes: Any) -> None:
        self.changes = changes
        self.channels, self.rows, self.branch, self.reach = ARM.channels, ARM.rows, ARM.branch, ARM.reach

    def at(self, joints: tuple[float, ...], mount: Mount) -> Any:
        return Chain(ARM.at(joints, mount), self.changes)

    def posture(self, l: float, psi: float) -> tuple[float, ...]:
        shift: float = self.changes.get("posture", 0.0)
        return ARM.posture(l + shift, psi)


class Chain:
    """A chain with some of its answers altered."""

    def __init__(self, inner: Chain2R, changes: dict[str, Any]) -> None:
        self._inner, self._changes = inner, changes

    def __getattr__(self, name: str) -> Any:
        right = getattr(self._inner, name)
        return self._changes[name](right) if name in self._changes else right

    def rates(self, v_m: float, w_m: float, rest: Rest, dt: float) -> tuple[tuple[float, ...], Verdict]:
        rates, verdict = self._inner.rates(v_m, w_m, rest, dt)
        change = self._changes.get("rated", lambda rates, dt: rates)
        return change(rates, dt), verdict

    def jacobian(self) -> Any:
        change = self._changes.get("slopes", lambda rows: rows)
        return change(self._inner.jacobian())

    def moved(self, rates: tuple[float, ...]) -> Moved:
        v_m, w_m, *rest = self._inner.moved(rates)
        return v_m, w_m + self._changes.get("moved_by", 0.0), *rest


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"hand": lambda hand: (hand[0] + 0.01, *hand[1:])}, "m apart"),
        ({"psi": lambda psi: psi + 7.0}, "m apart|not wrapped"),
        ({"l": lambda l: l + 1e-6}, "m apart"),
        ({"points": lambda points: points[:-1]}, "do not end at the hand"),
        ({"points": lambda points: ((1.0, 1.0, 0.0), *points[1:])}, "begin elsewhere"),
        ({"joints": lambda joints: (0.0, 0.0)}, "forgets its joints"),
        ({"slopes": lambda rows: ((0.1, rows[0][1]), *rows[1:])}, "row 0 of the Jacobian"),
        ({"slopes": lambda rows: rows[:2]}, "2 rows, not 6"),
        ({"towards_manipulability": lambda right: lambda: (0.1, right()[1])}, "gradient is off at joint 0"),
        ({"rated": lambda rates, dt: (rates[0] + 1e-3 * bool(rates[1]), rates[1])}, "rates are .* off"),
        ({"rated": lambda rates, dt: (rates[0] + 0.1 * dt, rates[1])}, "a period ends"),
        ({"moved_by": 1e-6}, "moved is not J dq"),
        ({"posture": 1e-3}, "posture is .* off"),
    ],
)
def test_an_arm_that_breaks_a_promise_is_found_out(changes: dict[str, Any], says: str) -> None:
    """The suite can fail: each promise, broken, is named with its joints."""
    arm: Arm = Broken(**changes)
    with pytest.raises(AssertionError, match=says):
        check_arm(arm, SAMPLES)
