"""Looking for a home: inverse kinematics from random postures, each branch measured coarsely, the largest kept."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import msgspec
import numpy as np

from overreach.arm.spatial.room import HOME
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.settle import Places, Posture
from overreach.errors import WorkspaceError
from overreach.model.measure.measure import measure
from overreach.model.measure.rank import random_postures
from overreach.model.mujoco.robot import Parts

LENGTHS = (0.5, 0.6, 0.7)
"""Lengths l that are tried, in parts of R."""
HEIGHTS = (-0.35, -0.15, 0.05)
"""Heights of the hand over the shoulder that are tried, in parts of R."""
ROLLS = (0.0, 0.5 * math.pi, math.pi, -0.5 * math.pi)
"""Rolls of the hand about its approach axis that are tried [rad]."""
STARTS = 40
"""Random postures for each of these."""
SETTLING = 90
APART = 0.4
"""Postures that differ by less than this [rad, m] in every joint, whole turns aside, are one."""
MOST = 60
"""At most so many branches are measured, those farthest from singular first."""
COARSE = 2.0
CLOSE = 1e-3


class Home(NamedTuple):
    """A posture, and the volume [m^3] of the sector about it, measured coarsely."""

    q: tuple[float, ...]
    volume: float


def attitudes(approach: tuple[float, float, float]) -> Iterator[Array]:
    """Yield attitudes (3, 3) of a hand at bearing 0 whose approach axis points straight ahead, in different rolls."""
    a = np.array(approach)
    other = np.eye(3)[int(np.argmin(np.abs(a)))]
    side = np.cross(a, other)
    side /= np.linalg.norm(side)
    own = np.stack((a, side, np.cross(a, side)))  # hand's axes -> ahead, left, up
    for roll in ROLLS:
        c, s = math.cos(roll), math.sin(roll)
        yield np.array(((1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c))) @ own


def branches(parts: Parts, seed: int = 0) -> list[tuple[float, tuple[float, ...]]]:
    """Return distinct postures with the hand in front, (sigma, joints), those farthest from singular first."""
    arm, R = parts.arm, parts.arm.manner.reach
    limits = arm.limits.copy()
    limits[:, HOME] = np.clip(0.5 * (limits[:, 0] + limits[:, 1]), -math.pi, math.pi)
    shoulder = float(arm.at(arm.home, parts.mount).places[arm.screws[:, 6] == 0.0][0][2])
    found: list[tuple[float, Array]] = []
    starts = random_postures(arm, STARTS, seed)
    for R_hand in attitudes(arm.manner.approach):
        posture = Posture(arm.screws, arm.tip, limits, arm.manner, R_hand)
        for length in LENGTHS:
            for height in HEIGHTS:
                place = (length * R, 0.0, shoulder + height * R, 0.0)
                goal = Places(*(np.full(STARTS, one) for one in place))
                settled = posture.settle(starts, goal, goal, walk=0, rest=SETTLING)
                for q, off, sigma in zip(*settled, strict=True):
                    if off < CLOSE * R and sigma > arm.manner.sigma:
                        found.append((float(sigma), q))
    found.sort(key=lambda one: -one[0])
    distinct: list[tuple[float, tuple[float, ...]]] = []
    for sigma, q in found:
        if all(_differ(q, np.array(other)) for _, other in distinct):
            distinct.append((sigma, tuple(q.tolist())))
    return distinct


def _differ(q: Array, other: Array) -> bool:
    apart = np.abs((q - other + math.pi) % (2.0 * math.pi) - math.pi)
    return bool(apart.max() > APART)


def find_homes(
    parts: Parts, at: Callable[[tuple[float, ...]], Parts], progress: Callable[[int, int], None] = lambda _a, _b: None
) -> list[Home]:
    """Return homes with a sector, the largest first. at: the parts of the robot with another home, in a mode."""
    tried = branches(parts)[:MOST]
    homes = []
    for k, (_, q) in enumerate(tried):
        progress(k, len(tried))
        rounded = tuple(round(one, 2) for one in q)
        try:
            there = at(rounded)
            result = measure(there.arm, there.mount, there.contacts(), "", COARSE, lambda _: None, there.base)
        except WorkspaceError:
            continue
        homes.append(Home(rounded, result.box.volume))
    return sorted(homes, key=lambda home: -home.volume)


def with_home(parts: Parts, q: tuple[float, ...]) -> Parts:
    """Return the robot with another home, its hand held in the same manner."""
    arm = parts.arm.made(q, parts.arm.manner, compiled=False)
    return parts._replace(arm=arm, description=msgspec.structs.replace(parts.description, home=q))
