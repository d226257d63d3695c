"""Which turnings of its hand an arm can hold: by the singular values of its task, over random postures."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from overreach.arm.spatial import task
from overreach.arm.spatial.arm import SpatialArm
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.settle import Posture
from overreach.errors import SetupError

POSTURES = 300
FARTHEST = 3000
"""Random postures of which the farthest hand gives the reach R."""
REAL = 0.015
"""A row is real in a posture where sigma is above this times R and the median speed of the hinges ..."""
SHARE = 0.5
"""... and the arm has it if it is real in so many of them."""
WIDEST = 2.0 * math.pi
WORDS = {task.PITCH: "pitch", task.SPIN: "spin", task.THIRD: "third"}
"""Turnings by their names in a robot's description."""


def random_postures(arm: SpatialArm, many: int, seed: int) -> Array:
    """Return random joints (many, n) within their limits, and within a turn of home where they have none."""
    lower = np.maximum(arm.limits[:, 0], np.array(arm.home) - WIDEST)
    upper = np.minimum(arm.limits[:, 1], np.array(arm.home) + WIDEST)
    return np.random.default_rng(seed).uniform(lower, upper, (many, len(lower)))


def farthest(arm: SpatialArm) -> float:
    """Return R [m]: the greatest horizontal distance of the hand from the shoulder that was met."""
    _, p, _ = arm.posture_at_home.forward(random_postures(arm, FARTHEST, 0))
    return float(np.hypot(p[:, 0], p[:, 1]).max())


def share_of(arm: SpatialArm, held: int, postures: Array) -> float:
    """Return the share of `postures` in which the arm has the place and the turnings `held`."""
    if task.count(held) - int(arm.aside) > len(arm.channels):
        return 0.0
    speeds = np.array([channel.rate_max for channel in arm.channels])
    hinges = speeds[arm.screws[:, 6] == 0.0]
    manner = msgspec.structs.replace(arm.manner, held=held)
    A = Posture(arm.screws, arm.tip, arm.limits, manner).task_jacobian(postures) * speeds
    least = np.linalg.svd(A, compute_uv=False)[:, -1]
    return float(np.mean(least > REAL * arm.manner.reach * float(np.median(hinges))))


def holds(arm: SpatialArm) -> int:
    """Return the turnings that the arm can hold beside the hand's place: pitch first, then spin, then the third.

    Raises SetupError for an arm that cannot even place its hand.
    """
    postures = random_postures(arm, POSTURES, 1)
    if share_of(arm, 0, postures) < SHARE:
        many = "two" if arm.aside else "three"
        raise SetupError(
            f"the arm cannot place its hand in {many} directions: what it has are fewer than {many} ways to move it"
        )
    if share_of(arm, task.WHOLE, postures) >= SHARE:  # its rows are never alike; those of the others may be
        return task.WHOLE
    held = 0
    for row in (task.PITCH, task.SPIN, task.THIRD):
        if share_of(arm, held | row, postures) >= SHARE:
            held |= row
    return held


def sentence(held: int, approach_up: float) -> str:
    """Say what the hand does, for the turnings that are held and the approach axis' share of up at home."""
    if held == task.WHOLE:
        return "all held"
    down = abs(approach_up) > 0.7
    match held:
        case 0:
            return "position only"
        case task.PITCH:
            return "hand vertical within the arm's plane, yaw follows" if down else "pitch held, yaw follows"
        case task.SPIN:
            return "level by construction, yaw held" if down else "roll held"
        case _ if held == task.PITCH | task.SPIN:
            return "hand vertical, yaw held" if down else "pitch and roll held, yaw follows"
        case _:
            return f"{' and '.join(WORDS[row] for row in WORDS if held & row)} held"
