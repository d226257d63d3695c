"""From a gated command to rates: feedback, frame, whole body, residual, limits, joints, guard."""

from __future__ import annotations

from math import inf, isfinite
from typing import cast

import msgspec
from msgspec.structs import astuple

from overreach.arm.chain import Chain, Governing, governs, is_aside
from overreach.arm.polar import wrap
from overreach.control.bounds import Bounds
from overreach.control.decision import Decision
from overreach.control.governed import Governor, amid, slipped
from overreach.control.reported import reported
from overreach.control.solved import Solved
from overreach.errors import LONGEST_NAME, SetupError, told
from overreach.gate.feedback import Feedback
from overreach.gate.guard import Guard
from overreach.gate.limits import limit_speed
from overreach.law.body import CarryingPlanner, Planner, UnusableError, WholeBody, check_fits, checked
from overreach.law.frame import FRAMES, heading_rate, meant, meant_by_tool
from overreach.law.recentre import NOT_CARRIED
from overreach.model.handed import hand_of
from overreach.model.model import Model, channels
from overreach.types import (
    Frame,
    HandTwist,
    PolarState,
    RobotState,
    Split,
    Takeover,
    Twist,
)
from overreach.verdicts import Motion, Verdict, weightier

NO_TWIST, NO_MOTION = Twist(), HandTwist()
MOVING = Verdict.MOVING  # used a dozen times per tick: a module's name is faster to look up than an enum's member

_with = msgspec.structs.replace


class HandController:
    """Turns a gated twist into base twist and joint rates. Keeps the hand's heading and what it last asked for.

    Its limits hold whatever the law says and the robot reports; nothing switches them off. If they cannot be kept,
    it ramps to zero and says FAULT until `reset`. Each period ends exactly at (l + v_m dt, psi + w_m dt).
    ramp_s: duration of the command's own ramp [s].
    """

    def __init__(self, model: Model, law: WholeBody, ramp_s: float = 0.0) -> None:
        all_of_them = channels(model)
        self.guard, self._feedback = Guard(all_of_them, ramp_s), Feedback(all_of_them)
        self._take(model)
        self._theta_e: float | None = None
        self._attitudes: dict[str, tuple[float, ...] | None] = {}
        self.frame, self._angle = law.frame, FRAMES[law.frame]
        self.configure(law)
        self.restart()

    def _take(self, model: Model) -> None:
        """Take a robot's arm for the one that is driven."""
        self.model = model
        self._arm, self._mount, self._base = model.arm, model.mount.three, model.base
        self._still = (0.0,) * len(model.arm.channels)
        self._governs = governs(model.arm)
        self._aside = is_aside(model.arm)
        self._whole = bool(getattr(model.arm, "whole", True))
        bounds = self._bounded(model)
        self._governor = Governor(model, bounds, self.guard)
        self._solved = Solved(model, bounds)

    def _bounded(self, model: Model) -> Bounds:
        return Bounds(model, self.guard)

    def configure(self, law: WholeBody, model: Model | None = None, planner: Planner | None = None) -> None:
        """Change the law. Changes nothing where it raises.

        model: the same robot with another workspace, or at rest with another of its hands driven; planner: that of the
        law for it, where it has been made before.
        """
        model = model or self.model
        check_fits(law, model)
        other_hand = hand_of(model) != hand_of(self.model)
        moved = model.mount != self.model.mount and not other_hand
        if moved or len(model.arm.channels) != len(self._still):
            raise SetupError("a law is changed for the same robot: its mount and its joints stay as they are")
        if other_hand and any(self.guard.written):
            raise SetupError("Let go first: another hand is driven only from rest.")
        name, closes, plan = str(law.name)[:LONGEST_NAME], bool(law.closes_residual), planner or law.planner(model)
        centring = law.recentring(model)
        if other_hand:
            self._attitudes[hand_of(self.model)] = self._governor.attitude
            self._take(model)
            self._governor.attitude = self._attitudes.get(hand_of(model))
            self._theta_e = None
            self._shares = 0.0, 0.0
            self.chain = self._arm.at(self._believed.q, model.mount)
        self.model = model
        self._governor.model = model
        self.law, self.name, self._closes, self._plan = law, name, closes, plan
        self._centring, self._carried = centring, NOT_CARRIED

    def restart(self) -> None:
        """Forget the past: the robot was put somewhere else, at rest. A fault stays."""
        start = self.model.start
        self._theta_e = None
        self._attitudes.clear()
        self._governor.restart()
        self._now = 0.0
        self._shares = (0.0, 0.0)
        posture = self._arm.posture(start.l, start.psi)
        self._believed = RobotState.flat(-inf, 0.0, 0.0, 0.0, 0.0, 0.0, posture, self._still)
        self.chain = self._arm.at(posture, self.model.mount)
        """The arm as it was last: whatever raises, there is one."""
        self._feedback.restart()
        self.guard.restart()

    def reset(self) -> None:
        """Leave FAULT. Moves nothing; what caused it is checked afresh."""
        if self.guard.fault:
            self._feedback.reset()
        self.guard.reset()

    def go_on(self, takeover: Takeover) -> bool:
        """Go on from the rates that the robot's host wrote by itself; say whether it is latched. Raises nothing."""
        try:
            rates = [float(rate) for rate in takeover.rates]
            keeps = [abs(rate) <= each.rate_max for rate, each in zip(rates, self.guard.channels, strict=True)]
            if not all(keeps):
                raise ValueError("rates beyond their limits")
        except Exception as error:  # a plug-in driver may report anything
            self.guard.latch(f"What the robot's host has written by itself cannot be used: {told(error)}.")
            return True
        self.guard.written = tuple(rates)
        self._feedback.asked.add(self.guard.written, self._now)
        if takeover.latched:
            self._feedback.reset()
        return takeover.latched

    def locate(self, state: RobotState) -> PolarState:
        """Return where the hand is, seen from the shoulder, and its heading."""
        return self._located(self._arm.at(state.q, self.model.mount), state)

    def _located(self, chain: Chain, state: RobotState) -> PolarState:
        if self._theta_e is None or self.frame is not Frame.HAND:  # in the others it follows r
            facing = cast(Governing, chain).facing if self._governs else 0.0
            self._theta_e = state.pose.yaw + chain.psi + self._mount[2] + facing
        return PolarState(chain.l, chain.psi, self._theta_e)

    def decide(
        self,
        state: RobotState | None,
        twist: Twist,
        dt: float,
        now: float | None = None,
        motion: Motion | None = None,
        frame: Frame | None = None,
    ) -> Decision:
        """Return the rates for the period `dt` [s] that begins in `state`, for a twist in `frame`. Raises nothing.

        state: None if there is none; the last one is kept. now [s]: the time, on the clock of `state.t`; by default
        that of a newer state, else dt later. motion: what the gate says; by default ALLOWED for a nonzero twist.
        frame: by default the last one. With a new frame, the hand's heading starts again from its bearing.
        """
        if frame is not None and frame is not self.frame:
            self.frame, self._angle, self._theta_e = frame, FRAMES[frame], None
        try:
            self._believe(state, dt, now)
        except Exception as error:  # a plug-in driver may report anything
            self.guard.latch(f"The robot's feedback cannot be used: {told(error)}.")
        state = self._believed
        finite = isfinite(sum(astuple(twist)))
        if not finite:
            twist = NO_TWIST
        if motion is None:
            motion = Motion.NONE if twist == NO_TWIST else Motion.ALLOWED
        try:
            self.chain = chain = self._arm.at(state.q, self.model.mount)
        except Exception as error:  # an arm that is a plug-in
            self.guard.latch(f"The arm's kinematics raised {told(error)}.")
            chain = self.chain
        try:
            decision = self._moving(chain, state, twist, dt) if self._asks(motion) else self._at_rest(chain, state)
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # likewise a law; some libraries' panics are not an Exception
            what = f"answered {error}" if isinstance(error, UnusableError) else f"raised {told(error)}"
            self.guard.latch(f"The law {self.name!r} {what}.")
            decision = self._at_rest(chain, state)
        if decision.split.verdict is Verdict.NO_SOLUTION:
            motion = Motion.NONE  # the law gives no motion
        decision, rates = self._last_word(wanted := decision, chain, motion, dt)
        self._feedback.asked.add(rates, self._now)
        if self.guard.fault:
            return _with(decision, verdict=Verdict.FAULT, fault=self.guard.fault)
        turn = heading_rate(self.frame, twist.w_z * decision.scale)
        if turn is not None and decision is wanted:
            self._theta_e = wrap(decision.polar.theta_e + turn * dt)
        return decision if finite else _with(decision, verdict=weightier(Verdict.NOT_FINITE, decision.verdict))

    def ramp(self, dt: float) -> Decision:
        """Return the next rates of the ramp to zero, without state, command or law. Used at the end of every run."""
        return self._written(self._at_rest(self.chain, self._believed), self.chain, self.guard.ramp(dt))

    def _believe(self, state: RobotState | None, dt: float, now: float | None) -> None:
        """Keep the time, and `state` if it can be believed; else latch a fault and keep the last believed state."""
        stamp = self._feedback.stamp
        if state is None:
            if stamp == -inf:
                self.guard.latch("The robot has reported nothing yet.")
                return
            state = self._believed
        self._now = now if now is not None else state.t if state.t > stamp else self._now + dt
        state, wrong = reported(state, self._feedback, self._base.omni, self._now)
        if wrong:
            self.guard.latch(wrong)
        elif state.t >= self._feedback.stamp:
            self._believed = state

    def _moving(self, chain: Chain, state: RobotState, twist: Twist, dt: float) -> Decision:
        """Return the decision for a command: the whole body's plan, the residual, the limits, the joints."""
        polar = self._located(chain, state)
        closes, is_ = self._closes, state.motion
        u, part = self._meant(twist, chain, polar, state)
        in_place = self._in_place
        asked = _with(u, w_z=0.0) if in_place else u
        base = self._base
        turning = self.guard.written[base.axes - 1] + self._governor.w_m
        asked = amid(asked, 0.5 * turning * dt) if self._governs else asked
        if self._centring is None:
            plan = checked(self._plan(chain, asked, is_))
        else:
            along = self._centring.along(asked)
            carried = self._centring.now(self._carried, along)
            plan = checked(cast(CarryingPlanner, self._plan)(chain, asked, is_, carried.part))
            self._carried = self._centring.after(carried, plan.split.mu, along, dt)
        split, own = plan.split, plan.joints
        if split.v_y is not None and not base.omni:
            raise UnusableError(f"v_y = {split.v_y:g}, but the base cannot move sideways")
        if self._governs and own is None:
            self._shares = split.mu, split.sigma
            slip = slipped(is_, base.twist(self._feedback.asked.in_force)) if closes else NO_TWIST
            return self._governor.decide(cast(Governing, chain), state, polar, u, split, slip, dt, part, in_place)
        off = slipped(is_, base.twist(self._feedback.asked.in_force)) if closes else None
        decision = self._solved.decide(chain, state, polar, u, plan, off, dt)
        self._shares = split.mu, split.sigma
        return decision

    def _meant(self, twist: Twist, chain: Chain, polar: PolarState, state: RobotState) -> tuple[HandTwist, float]:
        """Return what the twist means for the hand, and the part of it that may be commanded."""
        if self._governs and self.frame is Frame.TOOL:
            u = meant_by_tool(cast(Governing, chain).tool.tolist(), twist, polar.l, self._whole)
            swept = 0.0 if self._whole else u.w_z * polar.l
            return u, limit_speed(Twist(u.u_r, u.u_t - swept, u.u_z), self.model.command)[1]
        sweeps = 0.0 if self._aside else polar.l  # a hand that cannot go about the shoulder turns in its place
        u = meant(self._angle, twist, sweeps, polar.psi + self._mount[2], state.pose.yaw, polar.theta_e)
        if self._governs and not self._whole:
            u = _with(u, w_r=twist.w_x, w_t=twist.w_y)
        return u, 1.0

    @property
    def _in_place(self) -> bool:
        """Whether w_z turns the hand in its place, rather than its heading."""
        return self._governs and self._whole and self.frame is Frame.TOOL

    def _last_word(
        self, decision: Decision, chain: Chain, motion: Motion, dt: float
    ) -> tuple[Decision, tuple[float, ...]]:
        """Return `decision` with the rates that the guard writes, and those rates."""
        rates = decision.rates
        written = self.guard.write(rates, motion, dt)
        return decision if written == rates else self._written(decision, chain, written), written

    def _written(self, decision: Decision, chain: Chain, rates: tuple[float, ...]) -> Decision:
        """Return `decision` with other rates."""
        base = self._base.twist(rates)
        dtheta = rates[self._base.axes :]
        try:
            v_m, w_m, *_ = chain.moved(dtheta)
        except Exception as error:  # it is only told: what is written stands
            self.guard.latch(f"The arm's kinematics raised {told(error)}.")
            v_m = w_m = 0.0
        aside = base.v_y if self._base.omni else None
        split = _with(decision.split, v_b=base.v_x, w_b=base.w_z, v_m=v_m, w_m=w_m, v_y=aside)
        return _with(decision, split=split, joints=dtheta)

    def _at_rest(self, chain: Chain, state: RobotState) -> Decision:
        """Return a decision in which nothing moves."""
        self._governor.rest()
        self._carried = NOT_CARRIED
        rest = Split(*self._shares, 0.0, 0.0, 0.0, 0.0, v_y=0.0 if self._base.omni else None)
        return Decision(state, self._located(chain, state), NO_MOTION, rest, self._still, 1.0, MOVING)

    def _asks(self, motion: Motion) -> bool:
        """Say whether to ask the law: not while nothing may move, so that it cannot delay that either."""
        return motion is not Motion.NONE and not self.guard.fault
