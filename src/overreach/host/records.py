"""What a loop and the host of its robot tell each other: always the whole of it, so that no message may be missed."""

from __future__ import annotations

from typing import NamedTuple

import msgspec

from overreach.model.model import Model
from overreach.types import RobotState


class Ask(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """From the loop: the newest write, and how often each of the rare things has been asked for.

    number: of this message; now [s]: begin of the loop's period; due [s]: until when the rates are good; rates [m/s,
    rad/s]: channel by channel, none before the first write; gripper: its opening, 0 to 1, None to leave it; arms,
    restarts, stops: counts; hand: the one that the gripper is of, of a robot with several.
    """

    number: int = 0
    now: float = 0.0
    due: float = 0.0
    rates: tuple[float, ...] = ()
    gripper: float | None = None
    arms: int = 0
    restarts: int = 0
    stops: int = 0
    hand: str = ""


class Report(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """From the host: the robot's newest state, and what has been done.

    t [s]: when it was made; state: None where the robot could not be read; unreadable, failed, undone: why it could not
    be read, written to or armed, put back or stopped, or ""; number: of the newest message that was taken; arms,
    restarts, stops: its counts, all carried out.
    """

    t: float
    state: RobotState | None
    unreadable: str = ""
    failed: str = ""
    undone: str = ""
    number: int = 0
    arms: int = 0
    restarts: int = 0
    stops: int = 0


encode = msgspec.msgpack.Encoder().encode
decode_ask = msgspec.msgpack.Decoder(Ask).decode
decode_report = msgspec.msgpack.Decoder(Report).decode


class Made(NamedTuple):
    """The host's first word. model, simulated: of the robot; wrong: why there is none."""

    model: Model | None
    simulated: bool
    wrong: str = ""
