"""What page and cockpit say to each other over the WebSocket: JSON, one typed definition of every message.

A page's messages carry no operator: the cockpit gives each connection its number, and adds it.
"""

from __future__ import annotations

from typing import Annotated

import msgspec

from overreach.link.messages import Scene, Settings, State, Welcome
from overreach.types import Frame, Twist

LONGEST = 4096
"""Longest message [characters] that is taken from a page."""


Count = Annotated[int, msgspec.Meta(ge=0, le=2**53)]
"""A number that counts up, as exact in JavaScript as here."""


class CommandFromPage(msgspec.Struct, frozen=True, tag="command", forbid_unknown_fields=True):
    """See `overreach.types.Command`."""

    seq: Count
    grip: Count
    held: bool
    twist: Twist
    frame: Frame
    gripper: float | None = None
    seen: float = 0.0


class AskFromPage(msgspec.Struct, frozen=True, tag="ask", forbid_unknown_fields=True):
    """One of the buttons: `what` is stop, reset, arm, disarm or restart; `id` comes back in the answer."""

    id: int
    what: str


FromPage = CommandFromPage | AskFromPage


class Greeting(msgspec.Struct, frozen=True, tag="welcome"):
    """First message to a page: its operator number, the robot, the settings in force, and how to draw them."""

    operator: int
    robot: Welcome
    settings: Settings
    scene: Scene


class StateToPage(msgspec.Struct, frozen=True, tag="state"):
    """A state of the robot."""

    state: State


class AnswerToPage(msgspec.Struct, frozen=True, tag="answer"):
    """Whether the request was carried out and, if not, why."""

    id: int
    done: bool
    reason: str


class SettingsToPage(msgspec.Struct, frozen=True, tag="settings"):
    """The changed settings, and how to draw them."""

    settings: Settings
    scene: Scene


decode_from_page = msgspec.json.Decoder(FromPage).decode
encode = msgspec.json.Encoder().encode
