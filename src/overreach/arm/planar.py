"""The 2R arm in closed form: joints <-> the hand's polar coordinates about the shoulder.

With links a, b [m], joints theta_1, theta_2 [rad], e = a + b cos theta_2, f = b sin theta_2:
    l = sqrt(e^2 + f^2),   psi = theta_1 + atan2(f, e)
"""

from __future__ import annotations

import math
from math import acos, atan2, copysign, cos, hypot, pi, sin
from typing import final

from overreach.arm.chain import Moved, Point, Rest
from overreach.arm.mount import Mount
from overreach.arm.polar import wrap
from overreach.errors import SetupError
from overreach.types import Channel, Record
from overreach.verdicts import Verdict

SINE_DAMPED = 0.15
"""Below this |sin theta_2| the inverse of the Jacobian is damped: within 9 degrees of straight or folded."""

L_LEAST = 1e-6
"""Smallest length [m] that is used as a divisor: at l = 0 the bearing has no meaning."""


def forward(theta_1: float, theta_2: float, a: float, b: float) -> tuple[float, float]:
    """Return (l [m], psi [rad], not wrapped) of the hand."""
    e = a + b * cos(theta_2)
    f = b * sin(theta_2)
    return hypot(e, f), theta_1 + atan2(f, e)


def inverse(l: float, psi: float, a: float, b: float, elbow: int) -> tuple[float, float]:
    """Return (theta_1, theta_2) [rad] that put the hand at (l, psi), with theta_2 of the sign `elbow`.

    The two solutions are those of elbow = +1 and -1. l is held to the reach [|a - b|, a + b].
    """
    cosine = (l * l - a * a - b * b) / (2.0 * a * b)
    theta_2 = elbow * acos(max(-1.0, min(1.0, cosine)))
    return psi - atan2(b * sin(theta_2), a + b * cos(theta_2)), theta_2


def jacobian(theta_2: float, a: float, b: float) -> tuple[float, float]:
    """Return (j_l, j_psi), the second column of the polar Jacobian; the first is (0, 1).

    j_l = dl/dtheta_2 = -a b sin theta_2 / l [m/rad],   j_psi = dpsi/dtheta_2 = b (b + a cos theta_2) / l^2
    """
    c2 = cos(theta_2)
    l = max(hypot(a + b * c2, b * sin(theta_2)), L_LEAST)
    return -a * b * sin(theta_2) / l, b * (b + a * c2) / (l * l)


def polar_rates(theta_2: float, dtheta_1: float, dtheta_2: float, a: float, b: float) -> tuple[float, float]:
    """Return (v_m = dl/dt [m/s], w_m = dpsi/dt [rad/s]) for joint rates [rad/s]."""
    j_l, j_psi = jacobian(theta_2, a, b)
    return j_l * dtheta_2, dtheta_1 + j_psi * dtheta_2


def joint_rates(
    c2: float,
    s2: float,
    l: float,
    v_m: float,
    w_m: float,
    a: float,
    b: float,
    elbow: int,
) -> tuple[float, float, bool]:
    """Return (dtheta_1, dtheta_2 [rad/s], damped) for the hand's v_m = dl/dt [m/s], w_m = dpsi/dt [rad/s].

    c2, s2: cosine and sine of theta_2; l: the length [m] that belongs to it.
        dtheta_2 = v_m / j_l,   dtheta_1 = w_m - j_psi dtheta_2
    Near theta_2 = 0 or pi, where j_l goes to 0, motion towards the singularity is damped (it gives
    way smoothly) and motion away from it is bounded but not blocked, so that backing out is always
    possible. Never infinite.
    """
    l = max(l, L_LEAST)
    damped = False
    if -SINE_DAMPED < s2 < SINE_DAMPED:
        damped = v_m != 0.0
        if (v_m > 0.0) == (c2 > 0.0):
            dtheta_2 = -v_m * l * s2 / (a * b * SINE_DAMPED * SINE_DAMPED)
        else:
            side = copysign(SINE_DAMPED, s2 if s2 != 0.0 else elbow)
            dtheta_2 = -v_m * l / (a * b * side)
    else:
        dtheta_2 = -v_m * l / (a * b * s2)
    return w_m - b * (b + a * c2) / (l * l) * dtheta_2, dtheta_2, damped


class Arm2R(Record, frozen=True):
    """Two links in a plane.

    links: a, b [m]; elbow: sign of theta_2, +1 or -1; theta_min, theta_max [rad]; dtheta_max [rad/s];
    ddtheta_max [rad/s^2]; each of the last four per joint, from the shoulder out.
    """

    links: tuple[float, float]
    theta_min: tuple[float, float]
    theta_max: tuple[float, float]
    dtheta_max: tuple[float, float]
    ddtheta_max: tuple[float, float]
    elbow: int = 1

    def __post_init__(self) -> None:
        for speed, change in zip(self.dtheta_max, self.ddtheta_max, strict=True):
            for name, value in (("dtheta_max", speed), ("ddtheta_max", change)):
                if not (math.isfinite(value) and value > 0.0):
                    raise SetupError(f"arm {name} must be a finite number > 0, got {value:g}")
        for k, (least, most) in enumerate(zip(self.theta_min, self.theta_max, strict=True), start=1):
            if not -math.inf < least < most < math.inf:
                raise SetupError(f"arm theta_min must be below theta_max, got {least:g} and {most:g} rad for joint {k}")
        if not all(math.isfinite(link) and link > 0.0 for link in self.links):
            raise SetupError(f"arm links must be finite lengths > 0 m, got {self.links}")
        if self.elbow not in (-1, 1):
            raise SetupError(f"elbow must be 1 or -1, got {self.elbow}")

    @property
    def channels(self) -> tuple[Channel, ...]:
        """The two joints; see `overreach.arm.chain.Arm`."""
        limits = zip(self.dtheta_max, self.ddtheta_max, self.theta_min, self.theta_max, strict=True)
        return tuple(
            Channel(f"dtheta_{k}", f"theta_{k}", "rad", speed, change, least, most, dead_band=0.105)
            for k, (speed, change, least, most) in enumerate(limits, start=1)
        )

    @property
    def rows(self) -> tuple[int, ...]:
        """The plane alone: l and psi."""
        return (0, 1)

    @property
    def branch(self) -> tuple[tuple[float, float], ...]:
        """theta_2 ends where the arm is straight or folded: the elbow keeps its side."""
        (least_1, least_2), (most_1, most_2) = self.theta_min, self.theta_max
        return (least_1, most_1), (0.0, most_2) if self.elbow > 0 else (least_2, 0.0)

    @property
    def reach(self) -> tuple[float, float]:
        """Least and greatest distance of the hand from the shoulder [m]."""
        a, b = self.links
        return abs(a - b), a + b

    def at(self, joints: tuple[float, ...], mount: Mount) -> Chain2R:
        """Return the arm at `joints` [rad], mounted at `mount`."""
        return Chain2R(self, mount, joints)

    def posture(self, l: float, psi: float) -> tuple[float, float]:
        """Return the joints [rad] that put the hand at (l, psi), with the elbow on its side."""
        return inverse(l, psi, *self.links, self.elbow)


@final
class Chain2R:
    """The two-link arm at its joints; see `overreach.arm.chain.Chain`."""

    __slots__ = ("_a", "_b", "_bearing", "_c2", "_elbow", "_mount", "_s2", "joints", "l", "psi")

    def __init__(self, arm: Arm2R, mount: Mount, joints: tuple[float, ...]) -> None:
        theta_1, theta_2 = joints
        self._a, self._b = a, b = arm.links
        self._mount = mount
        self.joints = joints
        self._elbow = arm.elbow
        self._c2 = cos(theta_2)
        self._s2 = sin(theta_2)
        e = a + b * self._c2
        f = b * self._s2
        self.l = hypot(e, f)
        self._bearing = theta_1 + atan2(f, e)
        self.psi = wrap(self._bearing)

    @property
    def hand(self) -> Point:
        """The hand (x, y, 0) [m] in the base frame."""
        mount = self._mount
        psi_d = self.psi + mount.yaw
        return mount.s_x + self.l * cos(psi_d), mount.s_y + self.l * sin(psi_d), 0.0

    @property
    def points(self) -> tuple[Point, ...]:
        """Shoulder, elbow, hand."""
        mount = self._mount
        along = mount.yaw + self.joints[0]
        elbow = (mount.s_x + self._a * cos(along), mount.s_y + self._a * sin(along), 0.0)
        return (mount.s_x, mount.s_y, 0.0), elbow, self.hand

    @property
    def manipulability(self) -> float:
        """A b |sin theta_2| [m^2]."""
        return self._a * self._b * abs(self._s2)

    def towards_manipulability(self) -> tuple[float, ...]:
        """Return (0, a b cos theta_2 sign(sin theta_2)) [m^2/rad]."""
        return 0.0, self._a * self._b * self._c2 * copysign(1.0, self._s2)

    def jacobian(self) -> tuple[tuple[float, ...], ...]:
        """Return the rows of l, psi, z and the rotations; see `jacobian`."""
        j_l, j_psi = jacobian(self.joints[1], self._a, self._b)
        none = (0.0, 0.0)
        return (0.0, j_l), (1.0, j_psi), none, none, none, (1.0, 1.0)

    def rates(self, v_m: float, w_m: float, _rest: Rest, dt: float) -> tuple[tuple[float, float], Verdict]:
        """Return the joint rates [rad/s] with which a period of `dt` [s] ends where it should.

        Within SINE_DAMPED of straight or folded they are the instantaneous rates, damped, as with dt = 0.
        """
        a, b, s2, l = self._a, self._b, self._s2, self.l
        if dt > 0.0 and not -SINE_DAMPED < s2 < SINE_DAMPED:
            target = l + v_m * dt
            held = max(abs(a - b), min(a + b, target))
            end_1, end_2 = inverse(held, self._bearing + w_m * dt, a, b, 1 if s2 > 0.0 else -1)
            theta_1, theta_2 = self.joints
            if not -pi < theta_2 <= pi:  # the inverse knows no turns
                end_2 += 2.0 * pi * round((theta_2 - end_2) / (2.0 * pi))
            verdict = Verdict.MOVING if held == target else Verdict.OUT_OF_REACH
            return ((end_1 - theta_1) / dt, (end_2 - theta_2) / dt), verdict
        one, two, damped = joint_rates(self._c2, s2, l, v_m, w_m, a, b, self._elbow)
        if not damped:
            return (one, two), Verdict.MOVING
        outward = (v_m > 0.0) == (self._c2 > 0.0)  # outward when straight, or inward when folded
        return (one, two), Verdict.OUT_OF_REACH if outward else Verdict.SINGULAR

    def moved(self, rates: tuple[float, ...]) -> Moved:
        """Return (v_m, w_m, 0, 0, 0, w_z) for joint rates [rad/s]; the hand turns with its link."""
        one, two = rates
        v_m, w_m = polar_rates(self.joints[1], one, two, self._a, self._b)
        return v_m, w_m, 0.0, 0.0, 0.0, one + two
