"""From a gated command to rates: feedback, frame, whole body, residual, limits, joints, guard."""

from __future__ import annotations

from math import inf, isfinite
from operator import add

import msgspec

from overreach.arm.chain import NO_REST, Chain
from overreach.arm.limits import Room, room
from overreach.arm.polar import wrap
from overreach.errors import LONGEST_NAME, told
from overreach.gate.feedback import Feedback
from overreach.gate.guard import Guard
from overreach.gate.limits import clamp_change, feasible_scale
from overreach.law.authority import arm_residual
from overreach.law.body import UnusableError, WholeBody, checked
from overreach.law.frame import FRAMES, heading_rate
from overreach.model.model import Model, channels
from overreach.types import (
    BaseTwist,
    Frame,
    HandTwist,
    Motion,
    PolarState,
    RobotState,
    Split,
    Step,
    Verdict,
    weightier,
)

STILL = Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

_with = msgspec.structs.replace


class HandController:
    """Turns (v_c, w_c) into base twist and joint rates. Keeps the hand's heading and what it last asked for.

    Its limits hold whatever the law says and the robot reports; there is no switch for them. Where that cannot be, it
    ramps to zero and says FAULT until `reset`. Each period ends exactly where it should: at (l + v_m dt, psi + w_m dt).
    ramp_s: how long the command's own ramp takes [s].
    """

    def __init__(self, model: Model, law: WholeBody, frame: Frame | None = None, ramp_s: float = 0.0) -> None:
        self.model = model
        all_of_them = channels(model)
        self._arm, self._mount, self._joints = model.arm, model.mount.three, model.arm.channels
        self._still = (0.0,) * len(self._joints)
        self._tops = tuple(channel.rate_max for channel in all_of_them)
        self._changes = tuple(channel.change_max for channel in all_of_them)
        self.guard = Guard(all_of_them, ramp_s)
        self._feedback = Feedback(all_of_them)
        self.configure(law, frame)
        self.restart()

    def configure(self, law: WholeBody, frame: Frame | None = None, model: Model | None = None) -> None:
        """Change the law and the command frame; with another frame the hand's heading starts anew at its bearing.

        model: the same robot with another workspace.
        """
        model = model or self.model
        chosen = frame or law.frame  # all that may raise comes first
        name, closes, plan = str(law.name)[:LONGEST_NAME], bool(law.closes_residual), law.planner(model)
        self.model = model
        if getattr(self, "frame", None) is not chosen:
            self._theta_e: float | None = None
        self.law, self.name, self._closes, self._plan = law, name, closes, plan
        self.frame: Frame = chosen
        self._to_polar = FRAMES[chosen]

    def restart(self) -> None:
        """Forget the past: the robot was put somewhere else, at rest. A fault stays."""
        start = self.model.start
        self._theta_e = None
        self._now = 0.0
        self._rest = STILL
        posture = self._arm.posture(start.l, start.psi)
        self._believed = RobotState(-inf, 0.0, 0.0, 0.0, 0.0, 0.0, posture, self._still)
        self._feedback.restart()
        self.guard.restart()

    def reset(self) -> None:
        """Leave FAULT. Moves nothing; what caused it is looked at anew."""
        if self.guard.fault:
            self._feedback.reset()
        self.guard.reset()

    def locate(self, state: RobotState) -> PolarState:
        """Return where the hand is, seen from the shoulder, and its heading."""
        return self._located(self._arm.at(state.theta, self.model.mount), state)

    def _located(self, chain: Chain, state: RobotState) -> PolarState:
        bearing = state.theta_b + chain.psi + self._mount[2]
        if self._theta_e is None or heading_rate(self.frame, 0.0) is None:
            self._theta_e = bearing
        return PolarState(chain.l, chain.psi, self._theta_e)

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
        chain = self._arm.at(state.theta, self.model.mount)
        try:
            step = self._decide(chain, state, v_c, w_c, dt) if self._asks(motion) else self._at_rest(chain, state)
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # as above, a law; some libraries' panics are no Exception
            what = f"answered {error}" if isinstance(error, UnusableError) else f"raised {told(error)}"
            self.guard.latch(f"The law {self.name!r} {what}.")
            step = self._at_rest(chain, state)
        if step.split.verdict is not Verdict.MOVING:
            motion = Motion.NONE  # the law has nothing to give
        step = self._last_word(wanted := step, chain, motion, dt)
        self._feedback.asked.add(step.rates, self._now)
        if self.guard.fault:
            return _with(step, verdict=Verdict.FAULT, fault=self.guard.fault)
        turn = heading_rate(self.frame, w_c * step.scale)
        if turn is not None and step is wanted:
            self._theta_e = wrap(step.polar.theta_e + turn * dt)
        return step if finite else _with(step, verdict=weightier(Verdict.NOT_FINITE, step.verdict))

    def ramp(self, dt: float) -> Step:
        """Return the next rates on the way to zero: without state, command or law. For the end of every run."""
        chain = self._arm.at(self._believed.theta, self.model.mount)
        return self._written(self._at_rest(chain, self._believed), chain, self.guard.ramp(dt))

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

    def _decide(self, chain: Chain, state: RobotState, v_c: float, w_c: float, dt: float) -> Step:
        """Return what whole body, residual, limits and arm make of a command."""
        polar = self._located(chain, state)
        l, psi, mount, closes = polar.l, polar.psi, self._mount, self._closes
        u_r, u_t = self.commanded(v_c, w_c, l, psi, state.theta_b, polar.theta_e)
        plan = checked(self._plan(chain, HandTwist(u_r, u_t), BaseTwist(state.v_b, state.w_b)))
        split, own = plan.split, plan.joints
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
        owed = self._still
        if open_:
            v_m, w_m = arm_residual(l, psi, u_r * full, u_t * full, v_b + slip_v, w_b + slip_w, mount)
            owed = chain.rates(*arm_residual(l, psi, 0.0, 0.0, slip_v, slip_w, mount), NO_REST, 0.0)[0]
        if own is None:
            joints, short = chain.rates(v_m, w_m, NO_REST, dt)
        else:
            joints, short = tuple(map(add, own, owed)), Verdict.MOVING

        free = room(self._joints, state.theta, dt)
        scale, why = self._limit((v_b, w_b, *joints), owed, free, dt)
        if why is not Verdict.MOVING:
            verdict = why
        v_b, w_b = self._base(v_b * scale, w_b * scale, dt)
        if scale != 1.0 or (closes and (v_b != split.v_b or w_b != split.w_b)):
            if closes:
                k = full * scale
                v_m, w_m = arm_residual(l, psi, u_r * k, u_t * k, v_b + slip_v, w_b + slip_w, mount)
            else:
                v_m, w_m = v_m * scale, w_m * scale
            if own is None:
                joints, short = chain.rates(v_m, w_m, NO_REST, dt)
            else:
                joints = tuple([rate * scale + more for rate, more in zip(own, owed, strict=True)])
        bounded = self._bounded(joints, free, dt)
        if short is not Verdict.MOVING:
            verdict = short
        if short is not Verdict.MOVING or bounded != joints:
            joints = bounded
            v_m, w_m, *_ = chain.moved(joints)  # what the joints really give
        self._rest = Split(split.mu, split.sigma, 0.0, 0.0, 0.0, 0.0)
        applied = Split(split.mu, split.sigma, v_b, w_b, v_m, w_m, full * scale, split.verdict)
        return Step(state, polar, u_r, u_t, applied, joints, full * scale, verdict)

    def _limit(self, rates: tuple[float, ...], owed: tuple[float, ...], free: Room, dt: float) -> tuple[float, Verdict]:
        """Return the scale of the command at which no limit is passed, and why.

        rates: of base and joints at scale 1; owed: what the joints owe the base whatever the command is, a part of it.
        """
        v_b, w_b, *joints = rates
        fastest = [high if rate >= 0.0 else -low for rate, (low, high) in zip(joints, free, strict=True)]
        commanded = (v_b, w_b, *[rate - own for rate, own in zip(joints, owed, strict=True)])
        change = [most * dt for most in self._changes]
        most = (*self._tops[:2], *fastest)
        scale, verdict = feasible_scale(commanded, self.guard.written, most, change, (0.0, 0.0, *owed))
        if verdict is Verdict.SPEED and any(
            abs(rate) * scale >= top * 0.999 and top < usual * 0.999
            for rate, top, usual in zip(joints, fastest, self._tops[2:], strict=True)
        ):
            verdict = Verdict.JOINT_LIMIT
        return scale, verdict

    def _base(self, v_b: float, w_b: float, dt: float) -> tuple[float, float]:
        """Return the base's rates, held to its accelerations."""
        (was_v, was_w, *_), (dv, dw, *_) = self.guard.written, self._changes
        return clamp_change(v_b, was_v, dv * dt), clamp_change(w_b, was_w, dw * dt)

    def _bounded(self, joints: tuple[float, ...], free: Room, dt: float) -> tuple[float, ...]:
        """Return joint rates held to their limits: to what still stops in time, then to the accelerations."""
        return tuple(
            [
                clamp_change(max(low, min(high, rate)), was, change * dt)
                for rate, (low, high), was, change in zip(
                    joints, free, self.guard.written[2:], self._changes[2:], strict=True
                )
            ]
        )

    def _last_word(self, step: Step, chain: Chain, motion: Motion, dt: float) -> Step:
        """Return `step` with the rates that the guard writes."""
        rates = step.rates
        written = self.guard.write(rates, motion, dt)
        return step if written == rates else self._written(step, chain, written)

    def _written(self, step: Step, chain: Chain, rates: tuple[float, ...]) -> Step:
        """Return `step` with other rates."""
        v_b, w_b, *dtheta = rates
        v_m, w_m, *_ = chain.moved(tuple(dtheta))
        split = _with(step.split, v_b=v_b, w_b=w_b, v_m=v_m, w_m=w_m)
        return _with(step, split=split, dtheta=tuple(dtheta))

    def _at_rest(self, chain: Chain, state: RobotState) -> Step:
        """Return a step in which nothing moves."""
        return Step(state, self._located(chain, state), 0.0, 0.0, self._rest, self._still, 1.0, Verdict.MOVING)

    def _asks(self, motion: Motion) -> bool:
        """Say whether the law is asked: not while nothing may move, so that it cannot hold that up either."""
        return motion is not Motion.NONE and not self.guard.fault
