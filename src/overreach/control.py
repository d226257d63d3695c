"""From a gated command to rates: frame, law, limits, arm. The part that loop and experiments share."""

from __future__ import annotations

from typing import final

from overreach.arm.limits import fastest_joints
from overreach.arm.planar import forward, joint_rates_over, polar_rates, polar_to_joint_rates, wrap
from overreach.gate.limits import clamp_change, feasible_scale
from overreach.law.authority import arm_residual
from overreach.law.frame import FRAMES, heading_rate
from overreach.law.laws import JointLaw, Law
from overreach.model.planar import PlanarRobot
from overreach.types import BaseTwist, Frame, PolarState, Record, RobotState, Split, Verdict


class Step(Record, frozen=True):
    """What one step decided.

    polar: where the hand is; u_r, u_t: its commanded velocity [m/s]; split: the shares, with the rates
    as they are applied; dtheta: joint rates [rad/s]; scale: part of the command that is carried out;
    verdict: MOVING, or why it is less.
    """

    polar: PolarState
    u_r: float
    u_t: float
    split: Split
    dtheta: tuple[float, ...]
    scale: float
    verdict: Verdict

    @property
    def twist(self) -> BaseTwist:
        """The base twist that is applied."""
        return BaseTwist(self.split.v_b, self.split.w_b)


@final
class HandController:
    """Turns (v_c, w_c) into base twist and joint rates. Keeps the hand's heading and what it last asked for.

    limited: whether the robot's limits of speed and acceleration hold (they do wherever a robot moves;
    an experiment may want to see the law alone). whole_steps: whether joint rates are chosen so that the
    period ends exactly at (l + v_m dt, psi + w_m dt), or from the Jacobian.
    """

    def __init__(
        self,
        model: PlanarRobot,
        law: Law,
        frame: Frame | None = None,
        limited: bool = True,
        whole_steps: bool = False,
    ) -> None:
        self.model = model
        self.limited = limited
        self._whole_steps = whole_steps
        self._theta_e: float | None = None
        self._asked: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)
        self.configure(law, frame)

    def configure(self, law: Law, frame: Frame | None = None) -> None:
        """Change the law and the command frame; with another frame the hand's heading starts anew at its bearing."""
        chosen = frame or law.frame
        if getattr(self, "frame", None) is not chosen:
            self._theta_e = None
        self.law = law
        self._joint_law = law if isinstance(law, JointLaw) else None
        self.frame: Frame = chosen
        self._to_polar = FRAMES[chosen]
        mount = law.mount
        self._mount = (mount.s_x, mount.s_y, mount.yaw)

    def restart(self) -> None:
        """Forget the past: the robot was put somewhere else, at rest."""
        self._theta_e = None
        self._asked = (0.0, 0.0, 0.0, 0.0)

    def locate(self, state: RobotState) -> PolarState:
        """Return where the hand is, seen from the shoulder, and its heading."""
        theta_1, theta_2 = state.theta
        l, psi = forward(theta_1, theta_2, *self.model.arm.links)
        psi = wrap(psi)
        bearing = state.theta_b + psi + self._mount[2]
        if self._theta_e is None or heading_rate(self.frame, 0.0) is None:
            self._theta_e = bearing
        return PolarState(l, psi, self._theta_e)

    def commanded(
        self, v_c: float, w_c: float, l: float, psi: float, theta_b: float, theta_e: float
    ) -> tuple[float, float]:
        """Return the EE velocity (u_r, u_t) [m/s] that a command means with the hand at (l [m], psi [rad])."""
        return self._to_polar(v_c, w_c, l, psi + self._mount[2], theta_b, theta_e)

    def step(self, state: RobotState, v_c: float, w_c: float, dt: float) -> Step:
        """Return the rates for the period `dt` [s] that begins in `state`, for a command (v_c, w_c)."""
        polar = self.locate(state)
        l, psi = polar.l, polar.psi
        u_r, u_t = self.commanded(v_c, w_c, l, psi, state.theta_b, polar.theta_e)
        if self._joint_law is None:
            split = self.law.split(l, psi, u_r, u_t)
        else:
            split = self._joint_law.split_joints(state.theta, u_r, u_t)
        scale = split.scale
        verdict = split.verdict
        if verdict is Verdict.MOVING and scale < 1.0:
            verdict = Verdict.BESIDE

        v_b, w_b, v_m, w_m = split.v_b, split.w_b, split.v_m, split.w_m
        if self.limited:
            v_b, w_b, v_m, w_m, part, why = self._limit(state, split, dt)
            scale *= part
            if why is not Verdict.MOVING:
                verdict = why
        if self.law.closes_residual:
            # The base may not do what it is asked for: what it did differently it will go on doing.
            slip_v = state.v_b - self._asked[0]
            slip_w = state.w_b - self._asked[1]
            if slip_v != 0.0 or slip_w != 0.0 or scale != split.scale:
                part = scale / split.scale if split.scale > 0.0 else 0.0
                full = split.scale
                v_m, w_m = arm_residual(
                    l, psi, u_r * full * part, u_t * full * part, v_b + slip_v, w_b + slip_w, self._mount
                )
        own = split.dtheta
        if own is not None and split.scale > 0.0:
            own = tuple(rate * scale / split.scale for rate in own)
        dtheta, v_m, w_m, why = self._joints(state, v_m, w_m, own, dt)
        if why is not Verdict.MOVING:
            verdict = why

        self._asked = (v_b, w_b, *dtheta)
        turn = heading_rate(self.frame, w_c * scale)
        if turn is not None:
            self._theta_e = wrap(polar.theta_e + turn * dt)
        applied = Split(split.mu, split.sigma, v_b, w_b, v_m, w_m, scale, split.verdict, split.dtheta)
        return Step(polar, u_r, u_t, applied, dtheta, scale, verdict)

    def _limit(self, state: RobotState, split: Split, dt: float) -> tuple[float, float, float, float, float, Verdict]:
        """Return the four rates scaled alike until no limit is passed, the scale, and why."""
        arm, base = self.model.arm, self.model.base
        v_b, w_b, v_m, w_m = split.v_b, split.w_b, split.v_m, split.w_m
        dtheta_1, dtheta_2 = split.dtheta or polar_to_joint_rates(state.theta[1], v_m, w_m, *arm.links, arm.elbow)[:2]
        joints = fastest_joints(arm, state.theta, (dtheta_1, dtheta_2), dt)
        wanted = (v_b, w_b, dtheta_1, dtheta_2)
        change = (base.dv_max * dt, base.dw_max * dt, *(rate * dt for rate in arm.ddtheta_max))
        scale, verdict = feasible_scale(wanted, self._asked, (base.v_max, base.w_max, *joints), change)
        if verdict is Verdict.SPEED and any(
            abs(rate) * scale >= most * 0.999 and most < arm.dtheta_max[k] * 0.999
            for k, (rate, most) in enumerate(zip(wanted[2:], joints, strict=True))
        ):
            verdict = Verdict.JOINT_LIMIT
        return (
            clamp_change(v_b * scale, self._asked[0], change[0]),
            clamp_change(w_b * scale, self._asked[1], change[1]),
            v_m * scale,
            w_m * scale,
            scale,
            verdict,
        )

    def _joints(
        self, state: RobotState, v_m: float, w_m: float, own: tuple[float, ...] | None, dt: float
    ) -> tuple[tuple[float, ...], float, float, Verdict]:
        """Return joint rates, the polar rates that they give, and what kept them from what was asked.

        own: joint rates that the law has decided itself; else they follow from v_m, w_m.
        """
        arm = self.model.arm
        if own is not None:
            one, two = own
            verdict = Verdict.MOVING
        elif self._whole_steps:
            theta_1, theta_2 = state.theta
            one, two, verdict = joint_rates_over(theta_1, theta_2, v_m, w_m, dt, *arm.links, arm.elbow)
            if verdict is not Verdict.MOVING:
                now, _ = forward(theta_1, theta_2, *arm.links)
                then, _ = forward(theta_1 + one * dt, theta_2 + two * dt, *arm.links)
                v_m = (then - now) / dt
        else:
            one, two, damped = polar_to_joint_rates(state.theta[1], v_m, w_m, *arm.links, arm.elbow)
            verdict = Verdict.SINGULAR if damped else Verdict.MOVING
        if not self.limited:
            return (one, two), v_m, w_m, verdict
        steps = [rate * dt for rate in arm.ddtheta_max]
        one = clamp_change(one, self._asked[2], steps[0])
        two = clamp_change(two, self._asked[3], steps[1])
        most = fastest_joints(arm, state.theta, (one, two), dt)
        one, two = (max(-top, min(top, rate)) for rate, top in zip((one, two), most, strict=True))
        v_m, w_m = polar_rates(state.theta[1], one, two, *arm.links)  # what the joints really give
        return (one, two), v_m, w_m, verdict
