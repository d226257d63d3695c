"""From a gated command to rates: feedback, frame, law, residual, limits, arm, guard. Loop and scenarios share it."""

from __future__ import annotations

from math import cos, inf, isfinite
from operator import add

import msgspec

from overreach.arm.limits import Room, room
from overreach.arm.planar import forward, inverse, joint_rates_over, polar_rates, polar_to_joint_rates, wrap
from overreach.errors import LONGEST_NAME, told
from overreach.gate.feedback import Feedback
from overreach.gate.guard import Guard
from overreach.gate.limits import clamp_change, feasible_scale
from overreach.law.authority import arm_residual
from overreach.law.frame import FRAMES, heading_rate
from overreach.law.laws import JointLaw, Law, UnusableError, checked
from overreach.law.lead import lead
from overreach.model.planar import PlanarRobot
from overreach.types import Frame, Motion, PolarState, RobotState, Split, Step, Verdict, weightier

REST = (0.0, 0.0, 0.0, 0.0)
STILL = Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

_with = msgspec.structs.replace


class HandController:
    """Turns (v_c, w_c) into base twist and joint rates. Keeps the hand's heading and what it last asked for.

    Its limits hold whatever the law says and the robot reports; there is no switch for them. Where that cannot be, it
    ramps to zero and says FAULT until `reset`. whole_steps: whether joint rates are chosen so that the period ends
    exactly at (l + v_m dt, psi + w_m dt), or from the Jacobian. ramp_s: how long the command's own ramp takes [s].
    """

    def __init__(
        self, model: PlanarRobot, law: Law, frame: Frame | None = None, whole_steps: bool = False, ramp_s: float = 0.0
    ) -> None:
        self.model = model
        self.guard = Guard(model.channels, ramp_s)
        self._feedback = Feedback(model.channels)
        self._whole_steps = whole_steps
        self.configure(law, frame)
        self.restart()

    def configure(self, law: Law, frame: Frame | None = None) -> None:
        """Change the law and the command frame; with another frame the hand's heading starts anew at its bearing."""
        chosen = frame or law.frame  # all that may raise comes first
        name, closes = str(law.name)[:LONGEST_NAME], bool(law.closes_residual)
        mount = (law.mount.s_x, law.mount.s_y, law.mount.yaw)
        if getattr(self, "frame", None) is not chosen:
            self._theta_e: float | None = None
        self.law, self.name, self._mount, self._closes = law, name, mount, closes
        self._joint_law = law if isinstance(law, JointLaw) else None
        self.frame: Frame = chosen
        self._to_polar = FRAMES[chosen]

    def restart(self) -> None:
        """Forget the past: the robot was put somewhere else, at rest. A fault stays."""
        arm, start = self.model.arm, self.model.start
        self._theta_e = None
        self._now = 0.0
        self._rest = STILL
        self._believed = RobotState(
            -inf, 0.0, 0.0, 0.0, 0.0, 0.0, inverse(start.l, start.psi, *arm.links, arm.elbow), REST[2:]
        )
        self._feedback.restart()
        self.guard.restart()

    def reset(self) -> None:
        """Leave FAULT. Moves nothing; what caused it is looked at anew."""
        if self.guard.fault:
            self._feedback.reset()
        self.guard.reset()

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

    def step(
        self,
        state: RobotState | None,
        v_c: float,
        w_c: float,
        dt: float,
        now: float | None = None,
        motion: Motion | None = None,
    ) -> Step:
        """Return the rates for the period `dt` [s] that begins in `state`, for a command (v_c, w_c). Raises nothing.

        state: None where there is none; the last is kept. now [s]: the time, on the clock of `state.t`; by default that
        of a state that is newer, else dt later. motion: what a gate says; by default a command that is not 0 may move.
        """
        try:
            self._believe(state, dt, now)
        except Exception as error:  # a driver that is a plug-in may report anything
            self.guard.latch(f"The robot's feedback cannot be used: {told(error)}.")
        state = self._believed
        finite = isfinite(v_c + w_c)
        if not finite:
            v_c = w_c = 0.0
        if motion is None:
            motion = Motion.NONE if v_c == 0.0 and w_c == 0.0 else Motion.ALLOWED
        try:
            step = self._decide(state, v_c, w_c, dt) if self._asks(motion) else self._still(state)
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # as above, a law; some libraries' panics are no Exception
            what = f"answered {error}" if isinstance(error, UnusableError) else f"raised {told(error)}"
            self.guard.latch(f"The law {self.name!r} {what}.")
            step = self._still(state)
        if step.split.verdict is not Verdict.MOVING:
            motion = Motion.NONE  # the law has nothing to give
        step = self._last_word(wanted := step, motion, dt)
        self._feedback.asked.add(step.rates, self._now)
        if self.guard.fault:
            return _with(step, verdict=Verdict.FAULT, fault=self.guard.fault)
        turn = heading_rate(self.frame, w_c * step.scale)
        if turn is not None and step is wanted:
            self._theta_e = wrap(step.polar.theta_e + turn * dt)
        return step if finite else _with(step, verdict=weightier(Verdict.NOT_FINITE, step.verdict))

    def ramp(self, dt: float) -> Step:
        """Return the next rates on the way to zero: without state, command or law. For the end of every run."""
        return self._written(self._still(self._believed), self.guard.ramp(dt))

    def _believe(self, state: RobotState | None, dt: float, now: float | None) -> None:
        """Keep the time, and `state` where it can be believed; else latch the fault and keep the last that was."""
        stamp = self._feedback.stamp
        if state is None:
            if stamp == -inf:
                self.guard.latch("The robot has reported nothing yet.")
                return
            state = self._believed
        self._now = now if now is not None else state.t if state.t > stamp else self._now + dt
        state = state.plain
        positions = (complex(state.x_b, state.y_b), state.theta_b, *state.theta)
        wrong = self._feedback.check(state.t, positions, (state.v_b, state.w_b, *state.dtheta), self._now)
        if wrong:
            self.guard.latch(wrong)
        elif state.t >= self._feedback.stamp:
            self._believed = state

    def _decide(self, state: RobotState, v_c: float, w_c: float, dt: float) -> Step:
        """Return what law, residual, limits and arm make of a command."""
        polar = self.locate(state)
        l, psi, mount, closes = polar.l, polar.psi, self._mount, self._closes
        u_r, u_t = self.commanded(v_c, w_c, l, psi, state.theta_b, polar.theta_e)
        split = self._split(state, l, psi, u_r, u_t)
        full, verdict = split.scale, split.verdict
        if verdict is Verdict.MOVING and full < 1.0:
            verdict = Verdict.BESIDE
        v_b, w_b, v_m, w_m = split.v_b, split.w_b, split.v_m, split.w_m

        # The base may not do what it was asked for: what it did differently it will go on doing.
        slip_v = slip_w = 0.0
        if closes:
            then = self._feedback.asked.in_force
            slip_v, slip_w = state.v_b - then[0], state.w_b - then[1]
        open_ = closes and (slip_v != 0.0 or slip_w != 0.0 or self.model.base.lag > 0.0)
        owed = REST[2:]
        if open_:
            v_m, w_m = arm_residual(l, psi, u_r * full, u_t * full, v_b + slip_v, w_b + slip_w, mount)
            owed = self._solved(state, *arm_residual(l, psi, 0.0, 0.0, slip_v, slip_w, mount))
        own = split.dtheta
        joints = self._solved(state, v_m, w_m) if own is None else tuple(map(add, own, owed))

        free = room(self.model.arm, state.theta, dt)
        scale, why = self._limit((v_b, w_b, *joints), owed, free, dt)
        if why is not Verdict.MOVING:
            verdict = why
        v_b, w_b = self._base(v_b * scale, w_b * scale, dt)
        if open_ or (closes and scale != 1.0):
            k = full * scale
            v_m, w_m = arm_residual(l, psi, u_r * k, u_t * k, v_b + slip_v, w_b + slip_w, mount)
        else:
            v_m, w_m = v_m * scale, w_m * scale
        if own is not None:
            own = tuple(rate * scale + more for rate, more in zip(own, owed, strict=True))
        dtheta, v_m, w_m, why = self._joints(state, v_m, w_m, own, free, dt)
        if why is not Verdict.MOVING:
            verdict = why
        self._rest = Split(split.mu, split.sigma, 0.0, 0.0, 0.0, 0.0)
        applied = Split(split.mu, split.sigma, v_b, w_b, v_m, w_m, full * scale, split.verdict, split.dtheta)
        return Step(state, polar, u_r, u_t, applied, dtheta, full * scale, verdict)

    def _split(self, state: RobotState, l: float, psi: float, u_r: float, u_t: float) -> Split:
        """Return the law's answer; raises UnusableError where it is none."""
        lag = self.model.base.lag
        if self._joint_law is not None:
            split = self._joint_law.split_joints(state.theta, u_r, u_t)
        elif lag > 0.0 and self._closes:
            split = self.law.split(*lead(l, psi, u_r, u_t, state.v_b, state.w_b, lag, self._mount))
        else:
            split = self.law.split(l, psi, u_r, u_t)
        return checked(split)

    def _solved(self, state: RobotState, v_m: float, w_m: float) -> tuple[float, float]:
        """Return the joint rates [rad/s] of the hand's v_m [m/s], w_m [rad/s], by the Jacobian."""
        arm = self.model.arm
        return polar_to_joint_rates(state.theta[1], v_m, w_m, *arm.links, arm.elbow)[:2]

    def _limit(self, rates: tuple[float, ...], owed: tuple[float, ...], free: Room, dt: float) -> tuple[float, Verdict]:
        """Return the scale of the command at which no limit is passed, and why.

        rates: of base and joints at scale 1; owed: what the joints owe the base whatever the command is, a part of it.
        """
        arm, base = self.model.arm, self.model.base
        v_b, w_b, *joints = rates
        fastest = [high if rate >= 0.0 else -low for rate, (low, high) in zip(joints, free, strict=True)]
        commanded = (v_b, w_b, joints[0] - owed[0], joints[1] - owed[1])
        step_1, step_2 = arm.ddtheta_max
        change = (base.dv_max * dt, base.dw_max * dt, step_1 * dt, step_2 * dt)
        most = (base.v_max, base.w_max, *fastest)
        scale, verdict = feasible_scale(commanded, self.guard.written, most, change, (0.0, 0.0, *owed))
        if verdict is Verdict.SPEED and any(
            abs(rate) * scale >= top * 0.999 and top < arm.dtheta_max[k] * 0.999
            for k, (rate, top) in enumerate(zip(joints, fastest, strict=True))
        ):
            verdict = Verdict.JOINT_LIMIT
        return scale, verdict

    def _base(self, v_b: float, w_b: float, dt: float) -> tuple[float, float]:
        """Return the base's rates, held to its accelerations."""
        base = self.model.base
        was_v, was_w, *_ = self.guard.written
        return clamp_change(v_b, was_v, base.dv_max * dt), clamp_change(w_b, was_w, base.dw_max * dt)

    def _joints(
        self, state: RobotState, v_m: float, w_m: float, own: tuple[float, ...] | None, free: Room, dt: float
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
            if damped and (v_m > 0.0) == (cos(state.theta[1]) > 0.0):  # straight and farther out, or folded and in
                verdict = Verdict.OUT_OF_REACH
        bounded = self._bounded((one, two), free, dt)
        if bounded is not None:
            one, two = bounded
            v_m, w_m = polar_rates(state.theta[1], one, two, *arm.links)  # what the joints really give
        return (one, two), v_m, w_m, verdict

    def _bounded(self, dtheta: tuple[float, float], free: Room, dt: float) -> tuple[float, float] | None:
        """Return joint rates held to their limits: to what still stops in time, then to the accelerations."""
        one, two = [
            clamp_change(max(low, min(high, rate)), was, change * dt)
            for rate, (low, high), was, change in zip(
                dtheta, free, self.guard.written[2:], self.model.arm.ddtheta_max, strict=True
            )
        ]
        return one, two

    def _last_word(self, step: Step, motion: Motion, dt: float) -> Step:
        """Return `step` with the rates that the guard writes."""
        rates = step.rates
        written = self.guard.write(rates, motion, dt)
        return step if written == rates else self._written(step, written)

    def _written(self, step: Step, rates: tuple[float, ...]) -> Step:
        """Return `step` with other rates."""
        v_b, w_b, *dtheta = rates
        v_m, w_m = polar_rates(step.state.theta[1], dtheta[0], dtheta[1], *self.model.arm.links)
        split = _with(step.split, v_b=v_b, w_b=w_b, v_m=v_m, w_m=w_m)
        return _with(step, split=split, dtheta=tuple(dtheta))

    def _still(self, state: RobotState) -> Step:
        """Return a step in which nothing moves."""
        return Step(state, self.locate(state), 0.0, 0.0, self._rest, REST[2:], 1.0, Verdict.MOVING)

    def _asks(self, motion: Motion) -> bool:
        """Say whether the law is asked: not while nothing may move, so that it cannot hold that up either."""
        return motion is not Motion.NONE and not self.guard.fault
