"""The gate: every command passes it, every tick ends in one verdict. Pure: time comes in as `now`.

Freshness is the command's age at the receiver. Ramp: decelerate to zero and stay armed. Disarm: ramp, and then only
arming and a new press move the robot. What it reports passes `feedback`; what is written to it passes `guard`.
"""

from __future__ import annotations

import math
from typing import final

import msgspec
from msgspec.structs import astuple

from overreach.errors import SetupError
from overreach.gate.limits import Limits, limit_speed, slew
from overreach.gate.stop import StopLatch
from overreach.types import Command, Frame, Record, Twist
from overreach.verdicts import Motion, Verdict, weightier

_with = msgspec.structs.replace

STALE_S = 0.2
"""Without a fresh command for this long [s], the command ramps to zero."""
LOST_S = 1.0
"""Without a fresh command for this long [s], only a new press of the dead-man counts."""
TOLD_S = 0.5
"""How long a refusal is shown [s], unless a verdict is weightier."""
MAX_DELAY_S = 0.4
"""A command that is older than this [s], by the robot's own clock, is not obeyed ..."""
DELAYS = (0.1, 2.0)
"""... and this can be set from, and to [s]."""
OPERATORS_KEPT = 64
"""How many operators' last messages are remembered: of those who have armed, and as many of others."""
NEVER = (0, 0)
"""Numbers of the last message and the last press of an operator who has not been heard from yet."""


STILL = Twist()
PLANE = frozenset(("v_x", "v_y", "w_z"))
"""The parts of a twist that every robot's hand can follow."""


class Gated(Record, frozen=True):
    """What the gate lets through.

    twist: in `frame`; gripper: its wanted opening, None to leave it as it is; scale: applied by the speed limit;
    motion: whether anything may move; verdict, with a reason if it needs one.
    """

    twist: Twist
    frame: Frame
    gripper: float | None
    scale: float
    motion: Motion
    verdict: Verdict
    reason: str = ""


def check_delay(max_delay: float) -> float:
    """Return `max_delay` [s]; raises SetupError unless commands can keep it and an operator can drive with it."""
    if not DELAYS[0] <= max_delay <= DELAYS[1]:
        raise SetupError(f"--max-delay must be {DELAYS[0]:g} to {DELAYS[1]:g} s, got {max_delay:g}")
    return max_delay


@final
class Gate:
    """Holds the last accepted message and ramps the command. One `tick` per period.

    limits: of the command; speed_scale: fraction of `limits.v_c`, `limits.w_c` that full stick asks for; obeys: the
    parts of a twist, and "gripper", that the robot has; frames: those in which it can be commanded; a command for any
    other is refused, with the reason; max_delay [s]: how old a command may be. Its age is `now` less the time of the
    state that it echoes.
    """

    def __init__(
        self,
        limits: Limits | None = None,
        speed_scale: float = 1.0,
        obeys: frozenset[str] = PLANE,
        frames: frozenset[Frame] = frozenset(Frame),
        max_delay: float = MAX_DELAY_S,
    ) -> None:
        self.limits = limits or Limits()
        self._lacks = [name for name in Twist.__struct_fields__ if name not in obeys]
        self._grips = "gripper" in obeys
        self._frames = frames
        self.latch = StopLatch()
        self.speed_scale = speed_scale
        self.max_delay = check_delay(max_delay)
        self.refused = 0
        self.heard = 0
        """Number of the newest message of who has armed, accepted or not ..."""
        self.age = 0.0
        """... and how old it was when it came [s], 0 if that is not known."""
        self._said: Command | None = None
        self._fresh_at = self._held_at = -math.inf
        self._settling = False
        self._known: dict[int, tuple[int, int]] = {}
        self._others: dict[int, tuple[int, int]] = {}
        self._refusal = Verdict.OUT_OF_ORDER
        self._refused_at = -math.inf
        self._reason = ""
        self._twist = STILL
        self._wished: Twist | None = STILL
        self._goal, self._scale = limit_speed(STILL, self.limits)
        self._frame = Frame.HAND

    def set_speed_scale(self, value: float) -> None:
        """Set the speed scale; raises SetupError unless 0 < value <= 1."""
        if not 0.0 < value <= 1.0:
            raise SetupError(f"speed scale must be > 0 and <= 1, got {value:g}")
        self.speed_scale = value
        self._wished = None

    @property
    def resting(self) -> bool:
        """Say whether the command has come down to zero."""
        return self._twist == STILL

    @property
    def seq(self) -> int:
        """Number of the last accepted message, 0 before the first."""
        return self._said.seq if self._said else 0

    @property
    def seen(self) -> float | None:
        """The time [s] of the state that the operator's side had heard of when sending that message, if of any."""
        return self._said.seen if self._said else None

    def arm(self, operator: int, grip: int, now: float) -> Verdict | None:
        """Arm for `operator` at `now` [s]; return the verdict that forbids it, or None.

        Presses up to `grip` do not count: a dead-man that is already held moves nothing. The operator who armed before
        keeps the robot until it rests and LOST_S have passed since they armed or held. One who has been disarmed does
        not keep it; the robot comes to rest first.
        """
        latch = self.latch
        if latch.fault:
            return Verdict.FAULT
        if latch.stopped:
            return Verdict.STOPPED
        if latch.armed and latch.operator != operator and not (self.resting and now - self._held_at > LOST_S):
            return Verdict.OTHER_OPERATOR
        if latch.operator != operator:
            self._said = None
            self._settling = not self.resting
        last = self._known.pop(operator, None) or self._others.pop(operator, NEVER)
        _remember(self._known, operator, last)
        self.heard, pressed = last
        self._held_at = now
        latch.arm(operator, max(grip, pressed))
        return None

    def pause(self) -> None:
        """Disarm at once: the robot's host brings it to rest, whatever is asked for."""
        self.latch.pause()
        self._twist = STILL

    def forget(self) -> None:
        """Let only a later press count, with what it says: what the command means has changed."""
        if self._said is not None:
            self.latch.spend(self._said.grip)
            self._said = _with(self._said, gripper=None)

    def accept(self, said: Command, now: float) -> Verdict | None:
        """Take a message that arrived at `now` [s]; return why it is refused, or None.

        A command for a motion that the robot lacks counts as a command for rest.
        """
        latch = self.latch
        told = self._known if said.operator in self._known else self._others
        seq, grip = told.get(said.operator, NEVER)
        refusal: Verdict | None = None
        numbers = [*astuple(said.twist), *[one for one in (said.seen, said.gripper) if one is not None]]
        if not all(map(math.isfinite, numbers)):
            refusal = Verdict.NOT_FINITE
        elif said.seq <= seq:
            refusal = Verdict.OUT_OF_ORDER
        else:
            # Remembered for refused operators too: their old messages and presses stay old when they arm.
            _remember(told, said.operator, (said.seq, max(grip, said.grip)))
            if said.operator == latch.operator:
                self.heard, self.age = said.seq, 0.0 if said.seen is None else now - said.seen
            if latch.armed and said.operator != latch.operator:
                refusal = Verdict.OTHER_OPERATOR
            elif said.held and (said.seen is None or not 0.0 <= now - said.seen <= self.max_delay):
                return self._refuse(Verdict.DELAYED, now, self._too_old(said, now))
        if refusal:
            return self._refuse(refusal, now)
        if latch.armed and self._was_lost(now):
            # Lost while held: neither that press counts, nor one made during the silence.
            latch.spend(said.grip)
        self._said = said
        self._fresh_at = now
        if said.held:
            self._held_at = now
        if lacking := self._lacking(said):
            self._said = _with(said, twist=STILL, gripper=None)
            return self._refuse(Verdict.NO_SUCH_MOTION, now, f"It has no {', '.join(lacking)}.")
        return None

    def _too_old(self, said: Command, now: float) -> str:
        if said.seen is None or said.seen > now:
            return "A command echoes no state of this robot side, so that its age is not known."
        return f"A command was {now - said.seen:.2g} s old, {self.max_delay:g} s are allowed."

    def _refuse(self, refusal: Verdict, now: float, reason: str = "") -> Verdict:
        self.refused += 1
        self._refusal, self._refused_at, self._reason = refusal, now, reason
        return refusal

    def _lacking(self, said: Command) -> list[str]:
        """Return what is asked for but the robot lacks."""
        twist = said.twist
        if twist == self._twist and said.frame is self._frame and said.gripper is None:  # as it is going already
            return []
        asked = [name for name in self._lacks if getattr(twist, name) != 0.0]
        if said.frame not in self._frames and twist != STILL:
            asked.append(f"frame {said.frame.value!r}")
        if said.gripper is not None:
            if not self._grips:
                asked.append("gripper")
            elif not 0.0 <= said.gripper <= 1.0:
                asked.append("gripper's opening but 0 to 1")
        return asked

    def _was_lost(self, now: float) -> bool:
        return self._said is not None and self._said.held and now - self._fresh_at > LOST_S

    def _wish(self, now: float) -> tuple[Twist, Verdict]:
        """Return the command that is asked for and allowed at `now`, before speed limits and ramps."""
        latch, said = self.latch, self._said
        if latch.fault:
            return STILL, Verdict.FAULT
        if latch.stopped:
            return STILL, Verdict.STOPPED
        if not latch.armed:
            return STILL, Verdict.PAUSED if latch.paused else Verdict.DISARMED
        self._settling = self._settling and not self.resting
        if self._settling or said is None or said.operator != latch.operator or not said.held:
            return STILL, Verdict.RELEASED
        age = now - self._fresh_at
        if age > LOST_S:
            latch.spend(said.grip)
            return STILL, Verdict.LOST
        if age > STALE_S:
            if self.resting:
                latch.spend(said.grip)
            return STILL, Verdict.STALE
        if said.frame is not self._frame:
            if not self.resting:  # what the stick means does not change in motion
                latch.spend(said.grip)
                return STILL, Verdict.REGRIP
            self._frame = said.frame
        if said.grip <= latch.spent_grip:
            return STILL, Verdict.REGRIP
        return said.twist, Verdict.MOVING

    def tick(self, now: float, dt: float) -> Gated:
        """Return the command for the period `dt` [s] that begins at `now` [s]."""
        wish, verdict = self._wish(now)
        if wish != self._wished:
            self._wished = wish
            scaled = Twist(*[part * self.speed_scale for part in astuple(wish)])
            self._goal, self._scale = limit_speed(scaled, self.limits)
        goal, scale = self._goal, self._scale
        self._twist, ramping = slew(self._twist, goal, self.limits, dt)
        gripper = None
        if verdict is Verdict.MOVING:
            gripper = self._said.gripper if self._said else None
            if scale < 1.0:
                verdict = Verdict.SPEED
            elif ramping:
                verdict = Verdict.ACCELERATION
        reason = ""
        if now - self._refused_at < TOLD_S and (told := weightier(self._refusal, verdict)) is not verdict:
            verdict, reason = told, self._reason
        motion = Motion.NONE if self.resting else Motion.ALLOWED if wish != STILL else Motion.RAMPING
        return Gated(self._twist, self._frame, gripper, scale, motion, verdict, reason)


def _remember(whom: dict[int, tuple[int, int]], operator: int, last: tuple[int, int]) -> None:
    """Note an operator's last message as the newest of OPERATORS_KEPT."""
    whom.pop(operator, None)
    whom[operator] = last
    if len(whom) > OPERATORS_KEPT:
        del whom[next(iter(whom))]
