"""Several arms as one, of which one is driven: its joints move, those of the others hold still."""

from __future__ import annotations

from typing import final

import msgspec

from overreach.arm.chain import Arm, Asked, Governing, Moved, Point, Rest, Step
from overreach.arm.mount import Mount
from overreach.arm.spatial.arm import NO_TURN
from overreach.arm.spatial.manner import Manner
from overreach.arm.spatial.screws import Array
from overreach.types import Channel
from overreach.verdicts import Verdict

Rates = tuple[float, ...]


@final
class OneOf:
    """See `overreach.arm.chain.Arm`. channels: of all arms, each joint once; own: the arm that is driven; still: where
    all joints are at the start [rad, m]; follows: what every one of the arms can.
    """

    governs = True

    def __init__(self, channels: tuple[Channel, ...], own: Arm, still: Rates, follows: frozenset[str]) -> None:
        self.channels, self.own, self.follows = channels, own, follows
        names = [channel.moves for channel in channels]
        self._where = [names.index(channel.moves) for channel in own.channels]
        self._still = still

    def picked(self, values: Rates) -> Rates:
        """Return what of all joints' `values` is the driven arm's."""
        return tuple([values[k] for k in self._where])

    def spread(self, values: Rates, others: Rates | None = None) -> Rates:
        """Return all joints' values, with the driven arm's in their places; the others': `others`, by default 0."""
        whole = list(others or (0.0,) * len(self.channels))
        for k, value in zip(self._where, values, strict=True):
            whole[k] = value
        return tuple(whole)

    @property
    def manner(self) -> Manner:
        """How the driven hand is held."""
        own: Manner = self.own.manner  # type: ignore[attr-defined]  # of an arm in space
        return own

    @property
    def whole(self) -> bool:
        """Whether the driven arm turns its hand about any axis."""
        return bool(getattr(self.own, "whole", True))

    @property
    def aside(self) -> bool:
        """Whether the driven arm cannot move its hand about the shoulder."""
        return bool(getattr(self.own, "aside", False))

    @property
    def turns(self) -> bool:
        """Whether the driven arm keeps its hand's yaw itself."""
        return bool(getattr(self.own, "turns", False))

    @property
    def rows(self) -> tuple[int, ...]:
        """Those of the driven arm."""
        return self.own.rows

    @property
    def branch(self) -> tuple[tuple[float, float], ...]:
        """The joints' limits."""
        return tuple((one.lower, one.upper) for one in self.channels)

    @property
    def reach(self) -> tuple[float, float]:
        """That of the driven arm."""
        return self.own.reach

    def at(self, joints: Rates, mount: Mount) -> OneOfChain:
        """Return the driven arm at its part of all `joints`, mounted at `mount`."""
        own: Governing = self.own.at(self.picked(joints), mount)  # type: ignore[assignment]  # of an arm that governs
        return OneOfChain(self, own, joints)

    def posture(self, l: float, psi: float) -> Rates:
        """Return joints that put the driven hand at (l, psi), the others as they are at the start."""
        return self.spread(self.own.posture(l, psi), self._still)


@final
class OneOfChain:
    """See `overreach.arm.chain.Governing`."""

    __slots__ = ("_arm", "_own", "joints")

    def __init__(self, arm: OneOf, own: Governing, joints: Rates) -> None:
        self._arm, self._own, self.joints = arm, own, joints

    @property
    def l(self) -> float:  # noqa: E743  the paper's symbol
        """Length [m]."""
        return self._own.l

    @property
    def psi(self) -> float:
        """Bearing [rad]."""
        return self._own.psi

    @property
    def hand(self) -> Point:
        """The driven hand in the base frame [m]."""
        return self._own.hand

    @property
    def points(self) -> tuple[Point, ...]:
        """The driven arm's links."""
        return self._own.points

    @property
    def attitude(self) -> Array:
        """The driven hand's attitude in the base frame, (3, 3)."""
        return self._own.attitude

    @property
    def tool(self) -> Array:
        """The driven hand's own axes."""
        return self._own.tool

    @property
    def facing(self) -> float:
        """As the driven arm's [rad]."""
        return self._own.facing

    @property
    def manipulability(self) -> float:
        """That of the driven arm."""
        return self._own.manipulability

    def towards_manipulability(self) -> Rates:
        """Return its gradient: 0 for the others."""
        return self._arm.spread(self._own.towards_manipulability())

    def heading(self, attitude: tuple[float, ...] | None = None) -> float:
        """See `Governing`."""
        return self._own.heading(attitude)

    def turning(
        self,
        w_c: float,
        w_b: float,
        joints: Rates,
        turn: Point = NO_TURN,
        attitude: tuple[float, ...] | None = None,
    ) -> Point:
        """See `Governing`."""
        return self._own.turning(w_c, w_b, self._arm.picked(joints), turn, attitude)

    def jacobian(self) -> tuple[tuple[float, ...], ...]:
        """Return the driven arm's, with nothing for the others' joints."""
        return tuple(map(self._arm.spread, self._own.jacobian()))

    def rates(self, v_m: float, w_m: float, rest: Rest, dt: float) -> tuple[Rates, Verdict]:
        """Return all joints' rates: the others' are 0."""
        rates, verdict = self._own.rates(v_m, w_m, rest, dt)
        return self._arm.spread(rates), verdict

    def moved(self, rates: Rates) -> Moved:
        """Return what the driven hand does at all joints' rates."""
        return self._own.moved(self._arm.picked(rates))

    def step(self, asked: Asked) -> Step:
        """Return the driven arm's step: the others' joints come to rest, and stay."""
        own = self._own.step(msgspec.structs.replace(asked, joints=self._arm.picked(asked.joints)))
        return msgspec.structs.replace(own, joints=self._arm.spread(own.joints))
