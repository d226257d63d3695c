"""The records that travel along the way of one command.

Units are m, rad and s; angles are counter-clockwise. Frames: the *world* (fixed), the *base*
(origin at the drive's turning centre, x forward, y to the left) and the *hand* (the end effector,
EE). Records are frozen and slotted; symbols are those of Kwon et al., Appl. Sci. 2026, 16(2), 712.
"""

from __future__ import annotations

import enum
import math

import msgspec

FLOATS = {float}


class Record(msgspec.Struct, frozen=True, gc=False):
    """Base of the frozen, slotted records (a compiled struct: 0.1 us to make)."""


class Frame(enum.StrEnum):
    """The frame in which the operator's command is meant (see `overreach.law.frame`)."""

    HAND = "hand"
    POLAR = "polar"
    BASE = "base"
    WORLD = "world"


class Motion(enum.Enum):
    """What the gate says of motion in one tick.

    ALLOWED: the operator moves the hand; RAMPING: nobody does, and the command is on its way to zero;
    NONE: the command is zero, and zero is what is written.
    """

    ALLOWED = enum.auto()
    RAMPING = enum.auto()
    NONE = enum.auto()


class Verdict(enum.StrEnum):
    """What became of a command in one tick, weightiest first: the one table of them.

    Each has a value, a word for a label, a sentence (what to do or know), and a look for the page: stop, down, warn,
    ready or go. `severity` counts down the table: 0 is the weightiest.
    """

    word: str
    sentence: str
    look: str
    severity: int

    def __new__(cls, value: str, word: str, sentence: str, look: str) -> Verdict:
        """Make a member whose value is `value`."""
        member = str.__new__(cls, value)
        member._value_ = value
        member.word = word
        member.sentence = sentence
        member.look = look
        member.severity = len(cls.__members__)
        return member

    ENDING = "ending", "Ending", "The robot side was told to end: the robot comes to rest.", "stop"
    FAULT = "fault", "Fault", "Press Reset, then Arm.", "stop"
    STOPPED = "stopped", "Stopped", "Press Reset, then Arm.", "stop"
    DISARMED = "disarmed", "Disarmed", "Press Arm, then hold the pad.", "down"
    LOST = "lost", "Link lost", "No command for 1 s. Let go and press again.", "warn"
    REGRIP = "regrip", "Let go", "The robot came to rest without commands. Let go and press again.", "warn"
    STALE = "stale", "Link slow", "No command for 200 ms: slowing down.", "warn"
    NOT_FINITE = "not_finite", "Refused", "A command held a value that is not finite.", "warn"
    OTHER_OPERATOR = "other_operator", "Refused", "Another operator has armed the robot.", "warn"
    OUT_OF_ORDER = "out_of_order", "Refused", "An old or repeated command came.", "warn"
    NO_SOLUTION = "no_solution", "No solution", "The law's solver found no answer: the robot is to stand still.", "warn"
    RELEASED = "released", "Ready", "Hold the pad to move the hand.", "ready"
    JOINT_LIMIT = "joint_limit", "Scaled", "A joint is near its limit: the whole command is scaled.", "warn"
    OUT_OF_REACH = "out_of_reach", "Out of reach", "The arm is at the end of its reach.", "warn"
    SINGULAR = "singular", "Damped", "The arm is almost straight or folded: it gives way there.", "warn"
    BESIDE = "beside", "Scaled", "The hand is beside the base, where driving cannot help it.", "warn"
    SPEED = "speed", "Scaled", "Speed limit: the whole command is scaled.", "warn"
    ACCELERATION = "acceleration", "Moving", "Acceleration limit: the whole command is ramped.", "go"
    MOVING = "moving", "Moving", "The hand moves as commanded.", "go"


def weightier(one: Verdict, other: Verdict) -> Verdict:
    """Return which of two verdicts is to be told: the one that stands higher in the table."""
    return one if one.severity <= other.severity else other


class Channel(Record, frozen=True):
    """One rate of a robot that is written and measured: of the base, or of a joint.

    name: its symbol; moves: the name of the position that it moves; unit: of that position, "m" or "rad", so that rates
    are in unit/s and changes of rates in unit/s^2; rate_max, change_max: greatest |rate| and |d rate/dt|; lower, upper:
    limits of the position; resolution: smallest change of it that the robot reports; dead_band: a rate below which the
    robot may stand still.
    """

    name: str
    moves: str
    unit: str
    rate_max: float
    change_max: float
    lower: float = -math.inf
    upper: float = math.inf
    resolution: float = 0.005
    dead_band: float = 0.0


class Command(Record, frozen=True):
    """What the operator asks of the hand.

    In the frames `hand` and `polar`: v_c [m/s] along the hand's heading or outward, w_c [rad/s]
    about the shoulder. In `base` and `world`: v_c and w_c are the x and y velocity [m/s].
    """

    v_c: float = 0.0
    w_c: float = 0.0


class Stick(Record, frozen=True, forbid_unknown_fields=True):
    """One message of the operator's: the whole state of stick and dead-man.

    operator: session nonce; seq: counts up within it; grip: number of this press of the dead-man; held:
    whether it is held; v_c, w_c: the command (see `Command`).
    """

    operator: int
    seq: int
    grip: int
    held: bool
    v_c: float
    w_c: float


class PolarState(Record, frozen=True):
    """The EE seen from the shoulder.

    l: length [m]; psi: bearing from the arm's own x axis [rad]; theta_e: heading of the hand in
    the world [rad].
    """

    l: float
    psi: float
    theta_e: float = 0.0


class BaseTwist(Record, frozen=True):
    """Motion of the base in its own frame: v_b [m/s] forward, w_b [rad/s] counter-clockwise."""

    v_b: float = 0.0
    w_b: float = 0.0


class HandTwist(Record, frozen=True):
    """The commanded velocity of the hand in polar axes: outward, counter-clockwise and up, at the base's heading.

    u_r, u_t, u_z [m/s]; w_r, w_t, w_z [rad/s].
    """

    u_r: float = 0.0
    u_t: float = 0.0
    u_z: float = 0.0
    w_r: float = 0.0
    w_t: float = 0.0
    w_z: float = 0.0


class Split(Record, frozen=True):
    """A law's answer: how one EE velocity is shared by base and arm.

    mu, sigma: the base's share of linear and of angular motion, 0 (arm) to 1 (base);
    v_b [m/s], w_b [rad/s]: base twist; v_m = dl/dt [m/s], w_m = dpsi/dt [rad/s]: the arm's rates;
    scale: the part of the command that is feasible, 0 to 1 (all rates are scaled alike);
    verdict: MOVING, or why a law has nothing to give (then all rates and the scale are 0).
    """

    mu: float
    sigma: float
    v_b: float
    w_b: float
    v_m: float
    w_m: float
    scale: float = 1.0
    verdict: Verdict = Verdict.MOVING


class Plan(Record, frozen=True):
    """A whole body's answer: who moves the hand, before any limit of the robot.

    split: shares and rates; joints: joint rates [rad/s, m/s], where the plan decides them itself; None where the arm is
    to find them for v_m and w_m.
    """

    split: Split
    joints: tuple[float, ...] | None = None


class RobotState(Record, frozen=True):
    """What a robot reports.

    t [s]; base pose x_b, y_b [m], theta_b [rad] in the world; base twist v_b [m/s], w_b [rad/s]
    that is happening; joint angles theta [rad] and joint rates dtheta [rad/s], from the shoulder out.
    """

    t: float
    x_b: float
    y_b: float
    theta_b: float
    v_b: float
    w_b: float
    theta: tuple[float, ...]
    dtheta: tuple[float, ...]

    @property
    def plain(self) -> RobotState:
        """The same in Python's own floats; raises where a number is none. Drivers like to report those of numpy."""
        t, *base = numbers = (self.t, self.x_b, self.y_b, self.theta_b, self.v_b, self.w_b)
        if set(map(type, (*numbers, *self.theta, *self.dtheta))) == FLOATS:
            return self
        x_b, y_b, theta_b, v_b, w_b = [float(number + 0.0) for number in base]  # a text is no number
        joints = [tuple([float(number + 0.0) for number in one]) for one in (self.theta, self.dtheta)]
        return RobotState(float(t + 0.0), x_b, y_b, theta_b, v_b, w_b, *joints)


class Step(Record, frozen=True):
    """What one step decided.

    state: the newest that is believed of the robot; polar: where the hand is; u_r, u_t: its commanded velocity [m/s];
    split: the shares, with the rates as they are written; dtheta: joint rates [rad/s]; scale: part of the command that
    is carried out; verdict: MOVING, or why it is less; fault: the reason where the verdict is FAULT, else empty.
    """

    state: RobotState
    polar: PolarState
    u_r: float
    u_t: float
    split: Split
    dtheta: tuple[float, ...]
    scale: float
    verdict: Verdict
    fault: str = ""

    @property
    def twist(self) -> BaseTwist:
        """The base twist that is written."""
        return BaseTwist(self.split.v_b, self.split.w_b)

    @property
    def rates(self) -> tuple[float, ...]:
        """All that is written, channel by channel."""
        return (self.split.v_b, self.split.w_b, *self.dtheta)
