"""An arm that cannot move its hand about the shoulder, such as a telescope to the side: the drive does, in its step.

The step is that of any arm in space, with one slide more before the first joint: a correction of the drive. So the arm
and the drive end every period together where they should, whatever the joints' curvature and the base's arc.
"""

from __future__ import annotations

import math
from typing import Any, final

import msgspec
import numpy as np

from overreach.arm.chain import Asked, Point, Step
from overreach.arm.mount import Mount
from overreach.arm.spatial.arm import SpatialArm, SpatialChain
from overreach.arm.spatial.manner import Manner
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.step import NOT_WHOLE
from overreach.types import Channel, Record
from overreach.verdicts import Verdict

FAR = 1e3
"""Limit [m] of a drive, which has none."""
ANY = 1e3
"""The correction may be whatever it has to [m/s^2]; what the base cannot do of it is cut off, and told."""
SHORT = 5e-4
"""What is cut off of a drive's speed counts as rounding up to this [m/s]."""
WHOLE = 1.0 - 1e-9
SURELY = 0.98
"""The drive is planned within this part of what its speed can change by: the rest is for what is not foreseen."""


class Drive(Record, frozen=True):
    """The base under an arm. yaw: of the arm's x axis in its frame [rad]; v_max [m/s], w_max [rad/s]."""

    yaw: float
    v_max: float
    w_max: float


@final
class SideArm(SpatialArm):
    """See `SpatialArm`; drive: what moves its hand about the shoulder."""

    aside = True

    def __init__(
        self,
        channels: tuple[Channel, ...],
        screws: Array,
        tip: Array,
        home: tuple[float, ...],
        manner: Manner,
        drive: Drive,
        compiled: bool | None = None,
    ) -> None:
        super().__init__(channels, screws, tip, home, msgspec.structs.replace(manner, aside=True), compiled)
        self.drive = drive
        corrects = Channel("dv_b", "the drive", "m", drive.v_max, ANY, -FAR, FAR)
        along = np.array(((math.cos(drive.yaw), -math.sin(drive.yaw), 0.0, 0.0, 0.0, 0.0, 1.0),))
        self.driven = SpatialArm(
            (corrects, *channels), np.concatenate((along, screws)), tip, (0.0, *home),
            msgspec.structs.replace(manner, aside=False), compiled,
        )  # fmt: skip

    def __reduce__(self) -> tuple[type[SpatialArm], tuple[Any, ...]]:
        """Travel between processes as what it is made from."""
        return SideArm, (
            self.channels, self.screws, self.tip, self.home, self.manner, self.drive, self._compiled,
        )  # fmt: skip

    def made(self, home: tuple[float, ...], manner: Manner, compiled: bool | None = None) -> SideArm:
        """Return the same arm with another home, its hand held in another manner."""
        return SideArm(self.channels, self.screws, self.tip, home, manner, self.drive, compiled)

    def at(self, joints: tuple[float, ...], mount: Mount) -> SideChain:
        """Return the arm at `joints` [rad, m], mounted at `mount`."""
        return SideChain(self, joints, mount)


@final
class SideChain(SpatialChain):
    """The arm at its joints; see `overreach.arm.chain.Governing`."""

    __slots__ = ("_side",)

    def __init__(self, arm: SideArm, joints: tuple[float, ...], mount: Mount) -> None:
        super().__init__(arm, joints, mount)
        self._side = arm

    @property
    def points(self) -> tuple[Point, ...]:
        """From the ground where its line begins through the hinges to the hand: slides have no place of note."""
        hinges = self.places[self._side.screws[:, 6] == 0.0].tolist()
        return self._mounted(0.0, 0.0, 0.0), *[self._mounted(*place) for place in hinges], self.hand

    @property
    def facing(self) -> float:
        """Ahead is where the gripper points, as seen from above: outward is only to its side."""
        forward_r, forward_t, _ = self.tool[:, 0].tolist()
        return math.atan2(forward_t, forward_r) if math.hypot(forward_r, forward_t) > LEVEL else 0.0

    def step(self, asked: Asked) -> Step:
        """Return the arm's step, with the drive's part in what is written to the base.

        The base turns only as fast as its drive can follow; where that does not help, the hand waits for it.
        How the base slips along its way nothing can make up for at once.
        """
        drive, mount = self._side.drive, self._mount
        psi_d = self.psi + mount.yaw
        c, sn = math.cos(psi_d), math.sin(psi_d)
        k_r, k_t = mount.s_x * sn - mount.s_y * c, self.l + mount.s_x * c + mount.s_y * sn
        if abs(sn) < LEAST:
            sn = LEAST
        v_b, _, w_b = asked.plan
        change_v, _, change_w = asked.change
        u_r, u_t, u_z = asked.u
        # Midway of the period the lever is a little longer, and the hand's velocity seen from a base that has turned.
        longer = 0.5 * asked.dt * (u_r - c * v_b - k_r * w_b)
        lever = (k_t + longer + 0.5 * asked.dt * u_r) / sn
        room = Room(asked.was, SURELY * change_v, change_w, drive.v_max, drive.w_max)
        slip_x, slip_y, slip_w = asked.slip
        slip_t = c * slip_y - sn * slip_x + k_t * slip_w
        driven = self._side.driven.at((0.0, *self.joints), mount)

        def tried(part: float) -> tuple[float, Step]:
            """Ask for a part of the command; return what is left of it, and the step."""
            turn, fits = room.within(part * w_b, lever, -part * u_t / sn)
            left = part * fits
            return left, driven.step(
                msgspec.structs.replace(
                    asked,
                    u=(left * u_r, left * u_t + slip_t, left * u_z),
                    w_c=left * asked.w_c,
                    plan=((k_t * turn - left * u_t) / sn, 0.0, turn),
                    joints=(0.0, *asked.joints),
                    turn=(left * asked.turn[0], left * asked.turn[1], left * asked.turn[2]),
                )
            )

        left, step = tried(1.0)
        verdict, reason = step.verdict, step.reason
        if step.scale < WHOLE and verdict is not Verdict.ACCELERATION:
            # What the arm cannot follow is scaled before the base is asked: then its drive and turning brake together.
            left, step = tried(left * step.scale)
            if step.verdict is not Verdict.MOVING:
                verdict, reason = step.verdict, step.reason
        scale = left * step.scale
        v_x, _, w_z = step.base
        wanted, most = v_x + step.joints[0], min(drive.v_max, asked.was[0] + change_v)
        v_x = max(-drive.v_max, asked.was[0] - change_v, min(most, wanted))
        if abs(wanted - v_x) > SHORT:  # the base cannot: what it does is told, and not called whole
            scale, verdict, reason = min(scale, NOT_WHOLE), Verdict.ACCELERATION, ""
        elif left < WHOLE and verdict is Verdict.MOVING:
            verdict = Verdict.SWINGING
        return msgspec.structs.replace(
            step, joints=step.joints[1:], base=(v_x, 0.0, w_z), scale=scale, verdict=verdict, reason=reason
        )


LEVEL = 0.3
"""A gripper points somewhere, as seen from above, where so much of its axis is level."""
LEAST = 1e-3
"""Sine of the angle between the arm and the base's way below which the drive does not move the hand across it."""


class Room(Record, frozen=True):
    """What a base can do in a period: the twist written last, how much it may change, its greatest speeds."""

    was: tuple[float, float, float]
    change_v: float
    change_w: float
    v_max: float
    w_max: float

    def within(self, w_b: float, lever: float, drive: float) -> tuple[float, float]:
        """Return a turning near w_b [rad/s], and the part of the command with which lever turning + part drive fits.

        lever [m], drive [m/s]: so a turning, and the whole command, drive the base.
        """
        low, high = max(self.was[2] - self.change_w, -self.w_max), min(self.was[2] + self.change_w, self.w_max)
        least, most = max(self.was[0] - self.change_v, -self.v_max), min(self.was[0] + self.change_v, self.v_max)
        ends = sorted(((least - drive) / lever, (most - drive) / lever)) if lever != 0.0 else [low, high]
        if ends[1] >= low and ends[0] <= high:
            return max(low, ends[0], min(high, ends[1], w_b)), 1.0
        turn = low if ends[1] < low else high
        over = max(least, min(most, lever * turn + drive)) - lever * turn
        return turn, max(0.0, min(1.0, over / drive)) if drive != 0.0 else 1.0
