"""The gate: every command passes it, every tick ends in one verdict. Pure: time comes in as `now`.

Freshness is age at the receiver. Ramp: decelerate to zero, staying armed. Disarm: ramp, then only
release and press. What the robot reports passes `feedback`, what is written to it `guard`.
"""

from __future__ import annotations

import math
from typing import final

from overreach.errors import SetupError
from overreach.gate.limits import Limits, limit_speed, slew
from overreach.gate.stop import StopLatch
from overreach.types import Motion, Record, Stick, Verdict, weightier

STALE_S = 0.2
"""Without a fresh command for this long [s], the command ramps to zero."""
LOST_S = 1.0
"""Without a fresh command for this long [s], the robot is disarmed."""
TOLD_S = 0.5
"""How long a refusal is told [s], where nothing weightier is."""
OPERATORS_KEPT = 64
"""How many operators' last messages are remembered."""
NEVER = (0, 0)
"""Number of the last message and the last press of an operator who has not been heard."""


class Gated(Record, frozen=True):
    """What the gate lets through: v_c, w_c, their scale by the speed limit, whether anything may move, verdict."""

    v_c: float
    w_c: float
    scale: float
    motion: Motion
    verdict: Verdict


@final
class Gate:
    """Holds what was accepted last and ramps the command. One `tick` a period.

    limits: of the command; speed_scale: part of `limits.v_c`, `limits.w_c` that the full stick asks for.
    """

    def __init__(self, limits: Limits | None = None, speed_scale: float = 1.0) -> None:
        self.limits = limits or Limits()
        self.latch = StopLatch()
        self.speed_scale = speed_scale
        self.refused = 0
        self._stick: Stick | None = None
        self._fresh_at = -math.inf
        self._seen: dict[int, tuple[int, int]] = {}
        self._refusal = Verdict.OUT_OF_ORDER
        self._refused_at = -math.inf
        self._v_c = 0.0
        self._w_c = 0.0

    def set_speed_scale(self, value: float) -> None:
        """Set the speed scale; raises SetupError unless 0 < value <= 1."""
        if not 0.0 < value <= 1.0:
            raise SetupError(f"speed scale must be > 0 and <= 1, got {value:g}")
        self.speed_scale = value

    @property
    def resting(self) -> bool:
        """Say whether the command has come down to zero."""
        return self._v_c == 0.0 and self._w_c == 0.0

    @property
    def seq(self) -> int:
        """Number of the last accepted message, 0 before the first."""
        return self._stick.seq if self._stick else 0

    def arm(self, operator: int, grip: int, now: float) -> Verdict | None:
        """Arm for `operator` at `now` [s]; return why not, or None.

        Presses up to `grip` do not count: a dead-man that is already held moves nothing. Whoever armed before
        keeps the robot until it rests and he has been silent for LOST_S.
        """
        latch = self.latch
        if latch.fault:
            return Verdict.FAULT
        if latch.stopped:
            return Verdict.STOPPED
        if latch.armed and latch.operator != operator and not (self.resting and now - self._fresh_at > LOST_S):
            return Verdict.OTHER_OPERATOR
        if latch.operator != operator:
            self._stick = None
        _, pressed = self._seen.get(operator, NEVER)
        latch.arm(operator, max(grip, pressed))
        return None

    def accept(self, stick: Stick, now: float) -> Verdict | None:
        """Take a message that arrived at `now` [s]; return why it is refused, or None."""
        latch = self.latch
        seq, grip = self._seen.get(stick.operator, NEVER)
        refusal: Verdict | None = None
        if not (math.isfinite(stick.v_c) and math.isfinite(stick.w_c)):
            refusal = Verdict.NOT_FINITE
        elif stick.seq <= seq:
            refusal = Verdict.OUT_OF_ORDER
        else:
            # Remembered for refused operators too: their old messages and presses stay old when they arm.
            self._seen.pop(stick.operator, None)
            self._seen[stick.operator] = (stick.seq, max(grip, stick.grip))
            if len(self._seen) > OPERATORS_KEPT:
                del self._seen[next(iter(self._seen))]
            if latch.armed and stick.operator != latch.operator:
                refusal = Verdict.OTHER_OPERATOR
        if refusal:
            self.refused += 1
            self._refusal = refusal
            self._refused_at = now
            return refusal
        if latch.armed and self._was_lost(now):
            # Lost while held: neither that press counts nor one that was made while nothing came through.
            latch.spend(stick.grip)
        self._stick = stick
        self._fresh_at = now
        return None

    def _was_lost(self, now: float) -> bool:
        return self._stick is not None and self._stick.held and now - self._fresh_at > LOST_S

    def _wish(self, now: float) -> tuple[float, float, Verdict]:
        """Return the command that is asked for and allowed at `now`, before speed limits and ramps."""
        latch, stick = self.latch, self._stick
        if latch.fault:
            return 0.0, 0.0, Verdict.FAULT
        if latch.stopped:
            return 0.0, 0.0, Verdict.STOPPED
        if not latch.armed:
            return 0.0, 0.0, Verdict.DISARMED
        if stick is None or stick.operator != latch.operator or not stick.held:
            return 0.0, 0.0, Verdict.RELEASED
        age = now - self._fresh_at
        if age > LOST_S:
            latch.spend(stick.grip)
            return 0.0, 0.0, Verdict.LOST
        if age > STALE_S:
            if self.resting:
                latch.spend(stick.grip)
            return 0.0, 0.0, Verdict.STALE
        if stick.grip <= latch.spent_grip:
            return 0.0, 0.0, Verdict.REGRIP
        return stick.v_c, stick.w_c, Verdict.MOVING

    def tick(self, now: float, dt: float) -> Gated:
        """Return the command for the period `dt` [s] that begins at `now` [s]."""
        v_c, w_c, verdict = self._wish(now)
        wished = v_c != 0.0 or w_c != 0.0
        v_c, w_c, scale = limit_speed(v_c * self.speed_scale, w_c * self.speed_scale, self.limits)
        self._v_c, self._w_c, ramping = slew((self._v_c, self._w_c), (v_c, w_c), self.limits, dt)
        if verdict is Verdict.MOVING:
            if scale < 1.0:
                verdict = Verdict.SPEED
            elif ramping:
                verdict = Verdict.ACCELERATION
        if now - self._refused_at < TOLD_S:
            verdict = weightier(self._refusal, verdict)
        motion = Motion.NONE if self.resting else Motion.ALLOWED if wished else Motion.RAMPING
        return Gated(self._v_c, self._w_c, scale, motion, verdict)
