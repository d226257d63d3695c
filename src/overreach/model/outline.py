"""The workspace as it looks from above: closed lines in the base frame."""

from __future__ import annotations

from math import ceil, cos, pi, sin

from overreach.arm.mount import Mount
from overreach.model.base import Base, Wheel
from overreach.model.model import Model

Outline = tuple[tuple[float, float], ...]
"""A closed line through (x, y) [m] in the base frame."""

PER_POINT = 0.06
"""Greatest angle [rad] between two points of an arc."""


def sector(mount: Mount, r0: float, r1: float, a0: float, a1: float) -> Outline:
    """Return the part of a ring about the shoulder between radii [m] and bearings from the arm's x axis [rad].

    Bearings count up to half a turn either way: the line has at most 2 pi / PER_POINT points and a few.
    """
    a0, a1, r0 = max(-pi, a0), min(pi, a1), max(0.0, r0)
    n = max(1, ceil((a1 - a0) / PER_POINT))
    angles = [mount.yaw + a0 + (a1 - a0) * k / n for k in range(n + 1)]
    outer = [(mount.s_x + r1 * cos(angle), mount.s_y + r1 * sin(angle)) for angle in angles]
    inner = [(mount.s_x + r0 * cos(angle), mount.s_y + r0 * sin(angle)) for angle in reversed(angles)]
    return tuple(outer + inner)


def workspace(model: Model) -> Outline:
    """Return the workspace of `model`."""
    space = model.workspace
    return sector(model.mount, space.l_min, space.l_max, space.psi_min, space.psi_max)


def bands(model: Model, width_l: float, width_psi: float) -> tuple[Outline, ...]:
    """Return where arm and base blend, for transition widths in length [m] and bearing [rad]; they do not overlap.

    What lies beyond the arm's reach is left out.
    """
    space, (_, reach) = model.workspace, model.arm.reach
    widest_l, widest_psi = space.widest
    width_l, width_psi = min(width_l, widest_l, 2.0 * reach), min(width_psi, widest_psi, 2.0 * pi)
    l_min, l_max, psi_min, psi_max = space.middles(width_l, width_psi)
    q, p = 0.5 * width_l, 0.5 * width_psi
    far = min(l_max + q, reach)
    parts = (
        (l_max - q, far, psi_min - p, psi_max + p),
        (l_min - q, l_min + q, psi_min - p, psi_max + p),
        (l_min + q, l_max - q, psi_max - p, psi_max + p),
        (l_min + q, l_max - q, psi_min - p, psi_min + p),
    )
    return tuple(sector(model.mount, *part) for part in parts if part[1] > part[0] and part[3] > part[2])


def wheels(base: Base) -> tuple[Wheel, ...]:
    """Return the wheels of a base; where they are not known, one at each side of a footprint that it drives between."""
    length, width = base.footprint
    return base.wheels or tuple(Wheel(0.0, side * 0.5 * width, 0.0, USUAL * length) for side in (1.0, -1.0))


USUAL = 0.17
"""Radius of a wheel, in parts of the footprint's length."""
