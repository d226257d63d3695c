"""A robot's workspace: rank test, walk, cuts, the largest sector; refused where it would be of no use."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import msgspec
import numpy as np

from overreach.arm.mount import Mount
from overreach.arm.spatial import task
from overreach.arm.spatial.arm import SpatialArm
from overreach.arm.spatial.manner import Manner
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.settle import Places, Posture
from overreach.errors import WorkspaceError
from overreach.model.base import Base
from overreach.model.description import Measured
from overreach.model.measure.box import Box, largest
from overreach.model.measure.rank import WORDS, holds, sentence
from overreach.model.measure.walk import FLOOR, OFF, YAW_STRIDE, Walked, walk
from overreach.model.mujoco.contact import Contacts

UNDER = "z = 0 of base.body"
BEARINGS = 1.05
"""The sector ends at this bearing [rad] from the way that the base drives at the latest, either way; from the arm's x
axis where the base moves sideways too."""
AHEAD = 0.15
"""The hand is so far [parts of R] ahead of the turning centre of a base that cannot move sideways."""
LONG = 0.245
"""A sector is preferred that is so long in l, in parts of R: a reach of 0.11 R then fits between its two bands."""
ROOM = 0.3
"""Room [rad] in bearing that a sector should have to either side of straight ahead."""
OBLIQUE, SIDEWAYS = 45.0, 90.0
"""How far [degrees] the sector may lie off the way that a differential base drives: beyond the first it is slow, beyond
the second it is refused."""
FIXED = 0.5
"""The greatest deviation D [rad] of a fixed yaw from the bearing."""
WIDEST_YAW = 2.0
"""The greatest deviation D [rad] of a fixed yaw of an arm that moves its hand along one line only: what it can, up to
this. Farther off, it yields before it has gone half round."""
ASIDE_MODES = ("fixed", "follow")
"""How an arm that moves its hand along one line only can hold it."""
SIGMA = 1.0 / 3.0
"""The least singular value of a workspace, in parts of full deflection v."""
SHARE_V, SHARE_BASE, SHARE_TURN, SHARE_SIGMA, SHARE_UP = 0.33, 0.6, 0.8, 3.0, 0.27
"""v = min(0.33 R/s, 0.6 v_max, 0.8 p_x (w_max - w), 3 sigma), v_z = 0.27 v; on a base that moves sideways too with
0.8 (v_max - w |s|) for the third, s the shoulder ..."""
TURN = 0.3
"""... and w [rad/s]."""
UPRIGHT = 0.97


class Result(NamedTuple):
    """A measurement: the table for the description, what the hand does, warnings, and the cells to draw.

    fastest [m/s]: full deflection v by the rule above.
    """

    measured: Measured
    does: str
    warnings: list[str]
    walked: Walked
    box: Box
    fastest: float


def held_in(mode: str, held: int, up: float) -> int:
    """Return the turnings that a mode holds, of those that the arm can; `up`: the approach axis' share of up."""
    if mode == "free":
        return 0
    if mode == "level":  # the row that is nearest to a turn about the vertical is left free
        return held & ~(task.SPIN if abs(up) > math.sqrt(0.5) else task.THIRD)
    return held


def can_be_fixed(held: int, up: float) -> bool:
    """Say whether a yaw can be held in the world while the bearing changes, on a base that cannot move sideways."""
    if held == task.WHOLE:
        return True
    return bool((held & task.SPIN and abs(up) >= UPRIGHT) or (held & task.THIRD and abs(up) <= 1.0 - UPRIGHT))


def manner_for(arm: SpatialArm, mode: str, v: float) -> Manner:
    """Return the manner in which a mode holds the hand; raises WorkspaceError where the arm cannot."""
    held = holds(arm)
    up = float((arm.R_home @ np.array(arm.manner.approach))[2])
    if mode == "fixed" and not can_be_fixed(held, up):
        raise WorkspaceError(
            f'mode "fixed" needs a yaw of the hand\'s own, and this arm has none ({sentence(held, up)})'
        )
    if arm.aside and mode not in ASIDE_MODES:
        raise WorkspaceError(
            f"mode {mode!r} is not for an arm that moves its hand along one line only: {' or '.join(ASIDE_MODES)} is"
        )
    kept = held_in(mode, held, up)
    return msgspec.structs.replace(arm.manner, held=kept, sigma=SIGMA * v, yaw=FIXED if mode == "fixed" else 0.0)


def widest_yaw(arm: SpatialArm, touching: Callable[[Array], bool]) -> float:
    """Return how far [rad] the hand's yaw can be turned at home, either way, in whole strides; at least FIXED.

    A base that swings turns by a quarter under a hand whose yaw stays. touching: as in `walk`.
    """
    posture = arm.posture_at_home
    home = Places(*(np.array([one]) for one in (posture.l, posture.psi, posture.z, 0.0)))
    most = WIDEST_YAW
    for sign in (1.0, -1.0):
        q, turned = posture.home[None], 0
        while (turned + 1) * YAW_STRIDE <= most:
            begin = home._replace(yaw=np.array([sign * turned * YAW_STRIDE]))
            end = home._replace(yaw=np.array([sign * (turned + 1) * YAW_STRIDE]))
            found = posture.settle(q, begin, end)
            held = found.off[0] <= OFF * arm.manner.reach and found.sigma[0] >= arm.manner.sigma
            if not held or touching(found.q[0]):
                break
            q, turned = found.q, turned + 1
        most = turned * YAW_STRIDE
    return max(FIXED, most)


def expected_speed(R: float, base: Base) -> float:
    """Return full deflection [m/s] as far as it is known before a workspace is."""
    return min(SHARE_V * R, SHARE_BASE * base.v_max)


def measure(
    arm: SpatialArm,
    mount: Mount,
    contacts: Contacts,
    model: str,
    coarse: float,
    progress: Callable[[int], None],
    base: Base,
) -> Result:
    """Return the workspace of `arm`, which holds its hand in its manner; raises WorkspaceError with the reason.

    mount: where the arm stands; model: the hash to note; base: its limits bound the full deflection.
    """
    if arm.aside and arm.turns:
        arm = arm.held(msgspec.structs.replace(arm.manner, yaw=widest_yaw(arm, lambda q: bool(contacts.touching(q)))))
    manner, R = arm.manner, arm.manner.reach
    anywhere = base.omni or arm.aside  # the hand need not be ahead of the base
    up = float((arm.R_home @ np.array(manner.approach))[2])
    turned = math.degrees(abs(mount.yaw))
    if turned > SIDEWAYS and not anywhere:
        raise WorkspaceError(
            f"the arm's sector lies {turned:.0f} degrees off the way that the base drives ([mount] yaw), where a base "
            "that cannot move sideways cannot help it: for an arm that works over the back give [base] heading"
        )
    if contacts.at_home:
        raise WorkspaceError(f"at home the arm touches its own robot: {contacts.names(contacts.at_home)}")
    if arm.posture_at_home.z <= FLOOR * R:
        raise WorkspaceError(
            f"at home the hand is {-arm.posture_at_home.z:.3f} m below the ground, the plane of {UNDER}: choose a home "
            "above it"
        )
    walked = walk(arm, manner.sigma, lambda q: bool(contacts.touching(q)), coarse, progress)
    if walked is None:
        raise WorkspaceError("the arm does not hold its home posture: it is at a joint's limit, or singular")
    if walked.sigma[walked.home] < manner.sigma:
        raise WorkspaceError(
            f"home is singular: the hand moves {walked.sigma[walked.home]:.3g} m/s in its worst direction there, "
            f"{manner.sigma:.3g} are needed"
        )
    ahead = ahead_of(mount, walked.l, walked.psi)
    least = -np.inf if anywhere else AHEAD * R
    aside = 0.0 if anywhere else mount.yaw
    ok = walked.ok & (np.abs(walked.psi + aside) <= BEARINGS + 1e-9)[None, :, None] & (ahead >= least)[:, :, None]
    if not ok[walked.home]:
        where = arm.posture_at_home
        if abs(where.psi + aside) > BEARINGS or ahead[walked.home[:2]] < least:
            raise WorkspaceError(
                f"home is beside the base: its hand is at psi = {where.psi:.2f} rad, "
                f"{ahead[walked.home[:2]]:.2f} m ahead of the turning centre; choose one in front of it"
                + (", or for an arm that works over the back [base] heading = 3.14159" if _behind(mount, where) else "")
            )
        raise WorkspaceError("around home the posture jumps to another branch: choose another home")
    cells = ok, walked.l, walked.psi, walked.z, walked.home
    box = largest(*cells, LONG * R) or largest(*cells)
    if box is None:
        raise WorkspaceError("around home there is no sector that is two cells wide: choose another home")
    l, psi, z = [(float(axis[a]), float(axis[b])) for axis, (a, b) in zip(walked[:3], box[:3], strict=True)]
    warnings = []
    if turned > OBLIQUE and not anywhere:
        warnings.append(
            f"the arm's sector lies {turned:.0f} degrees off the way that the base drives: it is slow, since the base "
            "has to come round before it helps"
        )
    if not arm.aside:
        warnings += _room(psi)
    inside = tuple(slice(a, b + 1) for a, b in box[:3])
    sigma = float(walked.sigma[inside].min())
    p_x = float(ahead[inside[:2]].min())
    words = tuple(WORDS[row] for row in WORDS if manner.held & row)
    measured = Measured(_round(l), _round(psi), _round(z), words, round(sigma, 4), round(p_x, 4), model, manner.yaw)
    most = fastest(R, sigma, p_x, base, mount, arm.aside)
    return Result(measured, sentence(manner.held, up), warnings, walked, box, most)


def _room(psi: tuple[float, float]) -> list[str]:
    """Return a warning where a sector has little room about straight ahead; raises WorkspaceError if it has none."""
    if (psi[0] > -1e-9 and psi[1] < ROOM) or (psi[1] < 1e-9 and psi[0] > -ROOM) or psi[0] > 1e-9 or psi[1] < -1e-9:
        raise WorkspaceError(
            f"the sector, psi = {psi[0]:.2f} to {psi[1]:.2f} rad, has no room about straight ahead: home is beside the "
            "base, or the shoulder too far behind its axle"
        )
    if -psi[0] < ROOM and psi[1] < ROOM:
        raise WorkspaceError(f"the sector, psi = {psi[0]:.2f} to {psi[1]:.2f} rad, is too narrow about straight ahead")
    if -psi[0] < ROOM or psi[1] < ROOM:
        return [f"little room in bearing to one side: psi = {psi[0]:.2f} to {psi[1]:.2f} rad"]
    return []


def fastest(R: float, sigma: float, p_x: float, base: Base, mount: Mount, aside: bool = False) -> float:
    """Return full deflection v [m/s], for a reach R [m], least singular value [m/s] and distance p_x [m] ahead.

    aside: whether the arm leaves what lies about its shoulder to the drive.
    """
    if aside:
        turning = base.v_max
    elif base.omni:  # it carries the hand at the hand's own speed, and its shoulder round at w
        turning = SHARE_TURN * max(0.0, base.v_max - TURN * math.hypot(mount.s_x, mount.s_y))
    else:
        turning = SHARE_TURN * p_x * max(0.0, base.w_max - TURN)
    return min(SHARE_V * R, SHARE_SIGMA * sigma, SHARE_BASE * base.v_max, turning)


def ahead_of(mount: Mount, l: Array, psi: Array) -> Array:
    """Return how far [m] the hand is ahead of the base's turning centre, (l, psi)."""
    return np.asarray(mount.s_x + l[:, None] * np.cos(psi + mount.yaw)[None, :])


def _behind(mount: Mount, home: Posture) -> bool:
    """Say whether the hand at home is behind the turning centre."""
    return mount.s_x + home.l * math.cos(home.psi + mount.yaw) < 0.0


def _round(pair: tuple[float, float]) -> tuple[float, float]:
    return round(pair[0], 4) + 0.0, round(pair[1], 4) + 0.0
