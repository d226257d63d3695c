"""The cells of a grid about the shoulder that the arm reaches from home, on one branch: breadth first, by layers."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from overreach.arm.spatial.arm import SpatialArm
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.settle import REST, STRIDE_L, STRIDE_PSI, STRIDE_Z, Places, Posture

Cells = NDArray[np.bool_]
Cell = tuple[int, int, int]

WIDE = 1.8
"""Bearings [rad] from the arm's x axis that are tried, either way."""
ONE_BEARING = 0.02
"""Bearings of an arm that has but one differ by this [rad]."""
NEAREST, FARTHEST = 0.12, 1.05
"""Lengths l that are tried, in parts of R."""
FLOOR = -0.02
"""The lowest height that is tried, in parts of R."""
UP = 22
"""Cells above and below home that are tried."""
OFF = 0.0022
"""How far off its task a hand may be, in parts of R."""
JUMP = 0.45
"""A joint's change [rad, m] between neighbours beyond which they are on different branches ..."""
JUMP_YAW = 1.4
"""... and from one yaw to the next."""
YAW_STRIDE = 0.125
NOT_REACHED, WEAK, TOUCHES, CANNOT_TURN = 1, 2, 3, 4


class Walked(NamedTuple):
    """The grid, and of each cell: whether it was accepted, why not, its posture and least singular value [m/s].

    home: home's cell.
    """

    l: Array
    psi: Array
    z: Array
    ok: Cells
    why: NDArray[np.int8]
    q: Array
    sigma: Array
    home: Cell


def grid(posture: Posture, coarse: float = 1.0) -> tuple[Array, Array, Array, Cell]:
    """Return the lengths, bearings and heights of the grid, and home's cell; home's l, z and psi = 0 are nodes."""
    R = posture.manner.reach
    step_l, step_z = STRIDE_L * R * coarse, STRIDE_Z * R * coarse
    below = int((posture.l - NEAREST * R) / step_l)
    above = int((FARTHEST * R - posture.l) / step_l)
    l = posture.l + step_l * np.arange(-max(0, below), max(0, above) + 1)
    wide = round(WIDE / STRIDE_PSI)
    psi = STRIDE_PSI * np.arange(-wide, wide + 1)
    if posture.manner.aside:
        psi = np.array((-ONE_BEARING, 0.0, ONE_BEARING))
    z = posture.z + step_z * np.arange(-UP, UP + 1)
    z = z[z > FLOOR * R]
    home = (max(0, below), int(np.argmin(abs(psi - posture.psi))), int(np.argmin(abs(z - posture.z))))
    return l, psi, z, home


def walk(
    arm: SpatialArm,
    sigma: float,
    touching: Callable[[Array], bool],
    coarse: float = 1.0,
    progress: Callable[[int], None] = lambda _: None,
) -> Walked | None:
    """Return the cells that the arm reaches from home; None where it does not hold home itself.

    sigma [m/s]: least singular value of a cell; touching: whether a posture (n,) touches the robot; coarse: how many
    times as long the strides are; progress: called with the number of cells of each layer.
    """
    posture = arm.posture_at_home
    R, n = posture.manner.reach, len(arm.channels)
    l, psi, z, home = grid(posture, coarse)
    shape = (len(l), len(psi), len(z))
    ok, tried, why = np.zeros(shape, bool), np.zeros(shape, bool), np.zeros(shape, np.int8)
    q, least = np.full((*shape, n), np.nan), np.zeros(shape)
    begin = Places(*(np.array([one]) for one in (posture.l, posture.psi, posture.z, 0.0)))
    first = _places(l, psi, z, np.array([home]))
    rested = posture.settle(posture.home[None], begin, first, rest=20 * REST)
    if rested.off[0] > OFF * R:
        return None
    ok[home] = tried[home] = True
    q[home], least[home] = rested.q[0], rested.sigma[0]
    layer = [home]
    while layer:
        progress(len(layer))
        pairs = _around(layer, shape, ok, tried & (why != NOT_REACHED))
        fresh: list[Cell] = []
        while pairs:  # a cell that was not reached from one neighbour is tried from the next
            now: list[tuple[Cell, Cell]] = []
            later: list[tuple[Cell, Cell]] = []
            seen: set[Cell] = set()
            for pair in pairs:
                (now if pair[1] not in seen else later).append(pair)
                seen.add(pair[1])
            parents, cells = np.array([pair[0] for pair in now]), np.array([pair[1] for pair in now])
            found = posture.settle(q[tuple(parents.T)], _places(l, psi, z, parents), _places(l, psi, z, cells))
            for k, (_, cell) in enumerate(now):
                tried[cell] = True
                why[cell] = _wrong(found.q[k], found.off[k], found.sigma[k], OFF * R, sigma, touching)
                if not why[cell]:
                    ok[cell], q[cell], least[cell] = True, found.q[k], found.sigma[k]
                    fresh.append(cell)
            pairs = [pair for pair in later if why[pair[1]] == NOT_REACHED]
        layer = fresh
    walked = Walked(l, psi, z, ok, why, q, least, home)
    if posture.manner.yaw > 0.0:
        _turn(walked, posture, sigma, touching, progress)
    _branches(walked, JUMP * coarse)
    return walked


def _wrong(q: Array, off: float, least: float, most_off: float, sigma: float, touching: Callable[[Array], bool]) -> int:
    if not off <= most_off:
        return NOT_REACHED
    if least < sigma:
        return WEAK
    return TOUCHES if touching(q) else 0


def _places(l: Array, psi: Array, z: Array, cells: NDArray[np.int_]) -> Places:
    return Places(l[cells[:, 0]], psi[cells[:, 1]], z[cells[:, 2]], np.zeros(len(cells)))


def _around(layer: list[Cell], shape: Cell, ok: Cells, settled: Cells) -> list[tuple[Cell, Cell]]:
    """Return (cell, neighbour) for the neighbours of a layer that are still to be tried."""
    pairs = []
    for i, j, k in layer:
        for near in ((i + 1, j, k), (i - 1, j, k), (i, j + 1, k), (i, j - 1, k), (i, j, k + 1), (i, j, k - 1)):
            inside = all(0 <= at < most for at, most in zip(near, shape, strict=True))
            if inside and not ok[near] and not settled[near]:
                pairs.append(((i, j, k), near))
    return pairs


def _turn(
    walked: Walked, posture: Posture, sigma: float, touching: Callable[[Array], bool], progress: Callable[[int], None]
) -> None:
    """Drop the cells in which the yaw cannot be turned by D from the bearing, either way."""
    most, R = posture.manner.yaw, posture.manner.reach
    turns = round(most / YAW_STRIDE)
    for sign in (1.0, -1.0):
        cells = np.argwhere(walked.ok)
        q = walked.q[tuple(cells.T)]
        for turn in range(turns):
            if not len(cells):
                return
            progress(len(cells))
            begin, end = _places(walked.l, walked.psi, walked.z, cells), _places(walked.l, walked.psi, walked.z, cells)
            begin, end = (
                begin._replace(yaw=begin.yaw + sign * turn * YAW_STRIDE),
                end._replace(yaw=end.yaw + sign * (turn + 1) * YAW_STRIDE),
            )
            found = posture.settle(q, begin, end, walk=2)
            good = (found.off <= OFF * R) & (found.sigma >= sigma) & (np.abs(found.q - q).max(axis=1) <= JUMP_YAW)
            if turn % 2:
                for k in np.flatnonzero(good):
                    good[k] = not touching(found.q[k])
            bad = tuple(cells[~good].T)
            walked.ok[bad], walked.why[bad] = False, CANNOT_TURN
            cells, q = cells[good], found.q[good]


def _branches(walked: Walked, jump: float) -> None:
    """Drop the cells of which a joint jumps by `jump` [rad, m] to an accepted neighbour."""
    q = np.where(walked.ok[..., None], walked.q, np.nan)
    jumps = np.zeros(walked.ok.shape)
    for axis in range(3):
        change = np.nan_to_num(np.abs(np.diff(q, axis=axis)), nan=0.0).max(axis=-1)
        for end in (slice(0, -1), slice(1, None)):
            where = [slice(None)] * 3
            where[axis] = end
            jumps[tuple(where)] = np.maximum(jumps[tuple(where)], change)
    walked.ok[jumps >= jump] = False
