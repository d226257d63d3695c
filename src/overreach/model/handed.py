"""A robot with several hands, of which one is driven: `overreach.model.model.Model`."""

from __future__ import annotations

from typing import final

import msgspec

from overreach.arm.mount import Mount
from overreach.arm.one_of import OneOf
from overreach.errors import SetupError, UnknownNameError
from overreach.gate.limits import Limits
from overreach.model.base import Base, Start
from overreach.model.described import DescribedRobot
from overreach.model.workspace import Workspace
from overreach.types import Channel


@final
class HandedRobot:
    """Robots that differ in the hand that is driven, by its name, as one. Raises SetupError where they cannot be.

    Full deflection is the least of all, so that it does not change with the hand.
    """

    def __init__(self, by_hand: dict[str, DescribedRobot], hand: str, name: str) -> None:
        if hand not in by_hand:
            raise UnknownNameError("hand", hand, by_hand)
        self._by_hand, self.hand, self.name = by_hand, hand, name
        self._own = own = by_hand[hand]
        each = tuple(by_hand.values())
        if len({one.arm.aside for one in each}) > 1:
            raise SetupError(f"the hands of {name} are driven by different laws: give each a description of its own")
        joints: dict[str, Channel] = {}
        still: dict[str, float] = {}
        for one in each:
            at = one.arm.posture(one.start.l, one.start.psi)
            for channel, value in zip(one.arm.channels, at, strict=True):
                if joints.setdefault(channel.moves, channel) != channel:
                    raise SetupError(
                        f"the joint {channel.moves!r} of {name} is another's too, with other speeds: give it the same"
                    )
                still.setdefault(channel.moves, value)
        follows = frozenset.intersection(*(one.arm.follows for one in each))
        self.arm = OneOf(tuple(joints.values()), own.arm, tuple(still.values()), follows)
        self.gripper = all(one.gripper for one in each)
        limits = [msgspec.structs.astuple(one.command) for one in each]
        self.command = Limits(*[min(values) for values in zip(*limits, strict=True)])

    @property
    def hands(self) -> tuple[str, ...]:
        """The hands that it has."""
        return tuple(self._by_hand)

    @property
    def summary(self) -> str:
        """One line about it."""
        return self._own.summary

    @property
    def mode(self) -> str:
        """How the hand is held."""
        return self._own.mode

    @property
    def base(self) -> Base:
        """The base that all stand on."""
        return self._own.base

    @property
    def mount(self) -> Mount:
        """Where the driven arm stands."""
        return self._own.mount

    @property
    def workspace(self) -> Workspace:
        """Where the driven arm works alone, with the others at their homes."""
        return self._own.workspace

    @property
    def start(self) -> Start:
        """Where the driven hand is at the start."""
        return self._own.start

    @property
    def bands(self) -> tuple[float, float, float]:
        """Usual widths of the driven arm's bands."""
        return self._own.bands

    def placed(self, mount: Mount, workspace: Workspace) -> HandedRobot:
        """Return the same with another workspace for the driven hand; raises WorkspaceError."""
        own = self._own.placed(mount, workspace)
        return HandedRobot({**self._by_hand, self.hand: own}, self.hand, self.name)

    def with_hand(self, hand: str) -> HandedRobot:
        """Return the same with another hand driven, in the workspace that was measured for it."""
        return HandedRobot(self._by_hand, hand, self.name)


def hands_of(model: object) -> tuple[str, ...]:
    """Return the hands of a robot that has several, else none."""
    return tuple(getattr(model, "hands", ()))


def hand_of(model: object) -> str:
    """Return the hand that is driven, of a robot that has several, else ""."""
    return str(getattr(model, "hand", ""))
