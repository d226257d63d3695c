"""What the gate says of motion, and the one table of verdicts on commands, weightiest first."""

from __future__ import annotations

import enum


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
    PAUSED = (
        "paused", "Disarmed",
        "The robot side was held up, so the robot came to rest by itself. Press Arm, then hold the pad.", "warn",
    )  # fmt: skip
    DISARMED = "disarmed", "Disarmed", "Press Arm, then hold the pad.", "down"
    DELAYED = "delayed", "Link slow", "Commands take too long to come: none is obeyed.", "warn"
    LOST = "lost", "Link lost", "No command for 1 s. Let go and press again.", "warn"
    REGRIP = "regrip", "Let go", "The robot came to rest without commands. Let go and press again.", "warn"
    STALE = "stale", "Link slow", "No command for 200 ms: slowing down.", "warn"
    NOT_FINITE = "not_finite", "Refused", "A command held a value that is not finite.", "warn"
    OTHER_OPERATOR = "other_operator", "Refused", "Another operator has armed the robot.", "warn"
    NO_SUCH_MOTION = "no_such_motion", "Refused", "The robot's hand cannot move so.", "warn"
    OUT_OF_ORDER = "out_of_order", "Refused", "An old or repeated command came.", "warn"
    NO_SOLUTION = "no_solution", "No solution", "The law's solver found no answer: the robot is to stand still.", "warn"
    RELEASED = "released", "Ready", "Hold the pad to move the hand.", "ready"
    JOINT_LIMIT = "joint_limit", "Scaled", "A joint is near its limit: the whole command is scaled.", "warn"
    OUT_OF_REACH = "out_of_reach", "Out of reach", "The arm is at the end of its reach.", "warn"
    SINGULAR = "singular", "Damped", "The arm is almost straight or folded: it gives way there.", "warn"
    OFF = "off", "Scaled", "The arm cannot follow exactly here: the whole command is scaled.", "warn"
    BESIDE = "beside", "Scaled", "The hand is beside the base, where driving cannot help it.", "warn"
    SWINGING = "swinging", "Swinging", "The base swings round behind the hand: the hand waits for it.", "go"
    SPEED = "speed", "Scaled", "Speed limit: the whole command is scaled.", "warn"
    HEIGHT = "height", "At its height", "The hand is at the end of its height: it goes on along the ground.", "warn"
    ACCELERATION = "acceleration", "Moving", "Acceleration limit: the whole command is ramped.", "go"
    MOVING = "moving", "Moving", "The hand moves as commanded.", "go"


def weightier(one: Verdict, other: Verdict) -> Verdict:
    """Return the weightier of two verdicts: the one that is higher in the table."""
    return one if one.severity <= other.severity else other
