"""The largest sector of accepted cells that contains home."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from overreach.arm.spatial.screws import Array
from overreach.model.measure.walk import Cell, Cells

THIN = 2
"""A sector is at least so many cells high."""


class Box(NamedTuple):
    """First and last cell along l, psi and z, and the volume in between [m^3]."""

    l: tuple[int, int]
    psi: tuple[int, int]
    z: tuple[int, int]
    volume: float


def largest(ok: Cells, l: Array, psi: Array, z: Array, home: Cell, long: float = 0.0) -> Box | None:
    """Return the box of accepted cells about `home` with the greatest integral of l dl dpsi dz, if there is one.

    long: its least extent in l [m].
    """
    i_h, j_h, k_h = home
    best: Box | None = None
    many = ok.shape[2]
    for k_a in range(k_h + 1):
        whole = ok[:, :, k_a : k_h + 1].all(axis=2)
        for k_b in range(k_h, many):
            whole = whole & ok[:, :, k_b]
            if not whole[i_h, j_h]:
                break
            if k_b - k_a < THIN:
                continue
            found = _flat(whole, l, psi, i_h, j_h, long)
            volume = found[0] * float(z[k_b] - z[k_a])
            if volume > 0.0 and (best is None or volume > best.volume):
                best = Box((found[1], found[2]), (found[3], found[4]), (k_a, k_b), volume)
    return best


def _flat(whole: Cells, l: Array, psi: Array, i_h: int, j_h: int, long: float) -> tuple[float, int, int, int, int]:
    """Return (area, i_a, i_b, j_a, j_b) of the greatest rectangle about (i_h, j_h) that is `long` enough."""
    # How far each column reaches from home's length, inward and outward; then a range of columns reaches as its least.
    inward = np.cumprod(whole[i_h::-1], axis=0).sum(axis=0)
    outward = np.cumprod(whole[i_h:], axis=0).sum(axis=0)
    best = (0.0, i_h, i_h, j_h, j_h)
    for j_a in range(j_h, -1, -1):
        if not inward[j_a]:
            break
        least_in, least_out = inward[j_a : j_h + 1].min(), outward[j_a : j_h + 1].min()
        for j_b in range(j_h, whole.shape[1]):
            if not inward[j_b]:
                break
            least_in, least_out = min(least_in, inward[j_b]), min(least_out, outward[j_b])
            i_a, i_b = int(i_h - least_in + 1), int(i_h + least_out - 1)
            area = 0.5 * float((l[i_b] ** 2 - l[i_a] ** 2) * (psi[j_b] - psi[j_a]))
            if area > best[0] and l[i_b] - l[i_a] >= long:
                best = (area, i_a, i_b, j_a, j_b)
    return best
