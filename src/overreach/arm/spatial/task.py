"""What the hand holds: the reference attitude, and the rows of the task that the arm has. Scalar: to be compiled.

Rows are the hand's velocity x, y, z in the base's axes and then, as the arm has them, its turning about t (PITCH),
about its approach axis a (SPIN) and about the third axis, a x t (THIRD), in units of length: angles times ell.
"""

from __future__ import annotations

import math

from overreach.arm.spatial.screws import Array

PITCH, SPIN, THIRD = 1, 2, 4
WHOLE = PITCH | SPIN | THIRD
"""All three: the base's own axes are taken instead, which span the same."""
FOLDED = 1.5
"""Where the pitch is all that is held, the yaw is the bearing's: an attitude farther off [rad] is that of an arm folded
back over its shoulder, in which no pitch can be told."""
YIELDS = 0.8
"""A fixed yaw yields from this part of its greatest deviation D from the bearing, to D at 2 - YIELDS of it ..."""
BEHIND, BEHIND_PART = 0.6, 1.2
"""... and goes back through the bearing within so much [rad] of half a turn, or this part of D where that is more and
there is room for it, so that nothing jumps there."""


def count(held: int) -> int:
    """Return the number of rows for the turnings `held`."""
    return 3 + (held & 1) + (held >> 1 & 1) + (held >> 2 & 1)


def rows(held: int, bearing: float, R: Array, approach: Array, ell: float, T: Array) -> None:
    """Write the task's rows, each a combination of v_x .. w_z, into `T` (count, 6). R: the reference attitude (9,)."""
    for i in range(T.shape[0]):
        for j in range(6):
            T[i, j] = 0.0
    for i in range(3):
        T[i, i] = 1.0
    if held == WHOLE:
        for i in range(3, 6):
            T[i, i] = ell
        return
    t_x, t_y = -math.sin(bearing), math.cos(bearing)
    a_x = R[0] * approach[0] + R[1] * approach[1] + R[2] * approach[2]
    a_y = R[3] * approach[0] + R[4] * approach[1] + R[5] * approach[2]
    a_z = R[6] * approach[0] + R[7] * approach[1] + R[8] * approach[2]
    k = 3
    if held & PITCH:
        T[k, 3], T[k, 4] = ell * t_x, ell * t_y
        k += 1
    if held & SPIN:
        T[k, 3], T[k, 4], T[k, 5] = ell * a_x, ell * a_y, ell * a_z
        k += 1
    if held & THIRD:
        m_x, m_y, m_z = -a_z * t_y, a_z * t_x, a_x * t_y - a_y * t_x
        size = ell / (math.sqrt(m_x * m_x + m_y * m_y + m_z * m_z) + 1e-12)
        T[k, 3], T[k, 4], T[k, 5] = size * m_x, size * m_y, size * m_z


def product(T: Array, J: Array, A: Array) -> None:
    """Write T J into `A`; the first three rows of T are the place itself."""
    for i in range(3):
        for k in range(J.shape[1]):
            A[i, k] = J[i, k]
    for i in range(3, T.shape[0]):
        for k in range(J.shape[1]):
            A[i, k] = T[i, 3] * J[3, k] + T[i, 4] * J[4, k] + T[i, 5] * J[5, k]


def held_part(T: Array, ell: float, e: Array) -> float:
    """Return how much [rad] of the rotation vector `e` (3,) [rad] is about the turnings that are held."""
    square = 0.0
    for i in range(3, T.shape[0]):
        one = (T[i, 3] * e[0] + T[i, 4] * e[1] + T[i, 5] * e[2]) / ell
        square += one * one
    return math.sqrt(square)


def yielding(wanted: float, most: float) -> tuple[float, float]:
    """Return (f, df/dwanted): how far the hand's yaw is past the bearing, where it is wanted `wanted` [rad] past it.

    f is `wanted` up to YIELDS most, eases to `most` [rad], and comes back through 0 at half a turn: continuous all
    the way round.
    """
    size = abs(wanted)
    sign = 1.0 if wanted >= 0.0 else -1.0
    begin, end = YIELDS * most, (2.0 - YIELDS) * most
    behind = min(max(BEHIND, BEHIND_PART * most), 0.97 * (math.pi - end))
    if size <= begin:
        return wanted, 1.0
    if size <= end:
        part = (size - begin) / (end - begin)
        return sign * (begin + (end - begin) * (part - 0.5 * part * part)), 1.0 - part
    if size < math.pi - behind:
        return sign * most, 0.0
    part = (size - math.pi + behind) / behind
    return sign * most * (1.0 - part * part), -2.0 * most * part / behind


def wanted(f: float, most: float) -> float:
    """Return the wanted yaw [rad] past the bearing, up to where it yields no further, that `yielding` makes `f` of."""
    size = abs(f)
    begin, span = YIELDS * most, 2.0 * (1.0 - YIELDS) * most
    if size <= begin or most == 0.0:
        return f
    part = 1.0 - math.sqrt(max(0.0, 1.0 - 2.0 * (size - begin) / span))
    return math.copysign(begin + span * part, f)
