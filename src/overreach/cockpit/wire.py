"""What page and cockpit say to each other over the WebSocket: JSON, one typed definition of every message.

A page's messages carry no operator: the cockpit gives each connection its number, and adds it.
"""

from __future__ import annotations

from typing import Annotated

import msgspec

from overreach.link.messages import Scene, Settings, State, Welcome
from overreach.types import Frame, Record, Twist

LONGEST = 4096
"""Longest message [characters] that is taken from a page."""


Count = Annotated[int, msgspec.Meta(ge=0, le=2**53)]
"""A number that counts up, as exact in JavaScript as here."""


class CommandFromPage(Record, frozen=True, tag="command"):
    """See `overreach.types.Command`. seq: counts commands and beats; shown: number of the newest picture that came."""

    seq: Count
    grip: Count
    held: bool
    twist: Twist
    frame: Frame
    gripper: float | None = None
    seen: float | None = None
    shown: Count = 0


class BeatFromPage(Record, frozen=True, tag="beat"):
    """Nobody holds on, and an answer is wanted: the page measures how late the link is."""

    seq: Count
    seen: float | None = None
    shown: Count = 0


class ShownFromPage(Record, frozen=True, tag="shown"):
    """Number n of the newest picture that has come."""

    n: Count


class AskFromPage(Record, frozen=True, tag="ask"):
    """One of the buttons: `what` is stop, reset, arm, disarm, restart, or frame NAME; the answer has the same `id`."""

    id: int
    what: str


FromPage = CommandFromPage | BeatFromPage | ShownFromPage | AskFromPage


class Greeting(Record, frozen=True, tag="welcome"):
    """To a page, first and when the robot side is another: its operator number, the robot, its settings, its look."""

    operator: int
    robot: Welcome
    settings: Settings
    scene: Scene


class HeardToPage(Record, frozen=True, tag="heard"):
    """Everything up to number `seq` was heard. Goes ahead of pictures.

    t [s]: time of the robot's newest state, 0 before the first; ago [s]: how long ago it came to the cockpit.
    """

    seq: int
    t: float
    ago: float


class StateToPage(Record, frozen=True, tag="state"):
    """A picture, by its number n: a state of the robot."""

    n: int
    state: State


class AnswerToPage(Record, frozen=True, tag="answer"):
    """Whether the request was carried out and, if not, why."""

    id: int
    done: bool
    reason: str


class SettingsToPage(Record, frozen=True, tag="settings"):
    """The changed settings, and how to draw them."""

    settings: Settings
    scene: Scene


decode_from_page = msgspec.json.Decoder(FromPage).decode
encode = msgspec.json.Encoder().encode
