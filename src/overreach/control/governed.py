"""Limits and residual for an arm that governs: it chooses its joint motions, and keeps the joints' limits by itself."""

from __future__ import annotations

import math
from typing import final

import msgspec

from overreach.arm.chain import Asked, Governing
from overreach.arm.polar import wrap
from overreach.control.bounds import Bounds
from overreach.control.decision import Decision
from overreach.gate.guard import Guard
from overreach.law.blend import rise_smoothstep
from overreach.model.base import Base
from overreach.model.model import Model
from overreach.model.workspace import Workspace
from overreach.types import BaseTwist, HandTwist, PolarState, RobotState, Split, Twist
from overreach.verdicts import Verdict

HELD_BACK = 0.5
"""The hand is said to be at its height where less than this part of the upward command is left."""


def slipped(is_: Twist, asked: BaseTwist) -> Twist:
    """Return how a base that moves at `is_` deviates from the twist that it was asked for."""
    return Twist(is_.v_x - asked.v_x, is_.v_y - asked.v_y, w_z=is_.w_z - asked.w_z)


def of_tops(base: Base, split: Split) -> float:
    """Return how many times its greatest speed or turning a base is to go."""
    along = abs(split.v_b) if split.v_y is None else math.hypot(split.v_b, split.v_y)
    return max(along / base.v_max, abs(split.w_b) / base.w_max)


def _three(base: Base, rates: tuple[float, ...]) -> tuple[float, float, float]:
    """Return the base's part of a robot's rates, or of their changes, as v_x, v_y, w_z."""
    return (rates[0], rates[1], rates[2]) if base.omni else (rates[0], 0.0, rates[1])


def amid(u: HandTwist, turn: float) -> HandTwist:
    """Return `u` along the axes at a hand whose bearing in the world has turned by `turn` [rad], half of a period's.

    A base that is asked for the twist of the period's beginning leaves the hand behind by its curvature, a little each
    period: where it carries the hand, the hand would creep out of the workspace.
    """
    return msgspec.structs.replace(u, u_r=u.u_r + turn * u.u_t, u_t=u.u_t - turn * u.u_r)


def within_height(u: HandTwist, z: float, space: Workspace, band: float) -> float:
    """Return u_z [m/s], tapered to 0 over the last `band` [m] before the height that the hand goes towards."""
    if u.u_z > 0.0:
        return u.u_z * (1.0 - rise_smoothstep(z - space.z_max + 0.5 * band, band))
    return u.u_z * (1.0 - rise_smoothstep(space.z_min + 0.5 * band - z, band))


@final
class Governor:
    """Decides for one robot whose arm governs.

    Keeps the heading that a yaw fixed in the world comes from, and the attitude that the hand holds.
    """

    def __init__(self, model: Model, bounds: Bounds, guard: Guard) -> None:
        self.model = model
        self._bounds, self._guard = bounds, guard
        self._heading: float | None = None
        self.attitude: tuple[float, ...] | None = None
        """The one that the hand holds at bearing 0, by rows; None: home's."""
        self.w_m = 0.0
        """How fast the arm turns the hand's bearing [rad/s], as it was decided last."""

    def rest(self) -> None:
        """Forget the heading: the next motion begins with the one that the hand has then."""
        self._heading = None
        self.w_m = 0.0

    def restart(self) -> None:
        """Hold the hand as at home: the robot was put to its start."""
        self.attitude = None
        self.rest()

    def decide(
        self, chain: Governing, state: RobotState, polar: PolarState, u: HandTwist, split: Split, slip: Twist,
        dt: float, part: float = 1.0, in_place: bool = False,
    ) -> Decision:  # fmt: skip
        """Decide for a law's split of `u`; slip: how the base deviates from what it is asked.

        part: of `u` that an operator may command; in_place: whether w_z turns the hand's attitude, not its heading.
        """
        bounds, model, written = self._bounds, self.model, self._guard.written
        at = model.base
        bounds.prepare(dt)
        u_z = within_height(u, chain.hand[2], model.workspace, model.bands[2]) if u.u_z != 0.0 else 0.0
        at_height = abs(u_z) < HELD_BACK * abs(u.u_z)
        if u_z != u.u_z:
            u = msgspec.structs.replace(u, u_z=u_z)
        bearing = state.pose.yaw + polar.psi + model.mount.yaw
        if self._heading is None:
            self._heading = bearing + chain.heading(self.attitude)
        held = self.attitude
        worst = of_tops(at, split)
        fast = min(part, 1.0 if worst <= 1.0 else 1.0 / worst)
        scale = split.scale * fast
        step = chain.step(
            Asked(
                u=(scale * u.u_r, scale * u.u_t, scale * u.u_z),
                w_c=0.0 if in_place else scale * u.w_z,
                delta=wrap(self._heading - bearing),
                plan=(split.v_b * fast, (split.v_y or 0.0) * fast, split.w_b * fast),
                slip=(slip.v_x, slip.v_y, slip.w_z),
                was=_three(at, written),
                change=_three(at, bounds.steps),
                joints=written[at.axes :],
                dt=dt,
                turn=(scale * u.w_r, scale * u.w_t, scale * u.w_z if in_place else 0.0),
                attitude=held,
            )
        )
        self.attitude = step.attitude
        scale *= step.scale
        if not in_place:
            self._heading += u.w_z * scale * dt
        verdict = step.verdict
        if verdict is Verdict.MOVING:
            if split.verdict is not Verdict.MOVING:
                verdict = split.verdict
            elif scale < 1.0:
                verdict = Verdict.SPEED if fast < 1.0 else Verdict.BESIDE
            elif at_height:
                verdict = Verdict.HEIGHT
        v_b, v_y, w_b = step.base
        v_m, w_m, *_ = chain.moved(step.joints)
        self.w_m = w_m
        aside = v_y if at.omni else None
        applied = Split(split.mu, split.sigma, v_b, w_b, v_m, w_m, scale, split.verdict, aside)
        return Decision(state, polar, u, applied, step.joints, scale, verdict, reason=step.reason, attitude=held)
