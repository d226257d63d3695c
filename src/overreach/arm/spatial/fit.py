"""Joint rates that fit their limits: the posture gives way first, then joint after joint. Scalar: to be compiled.

1 all fits; 2 the null part shrinks; 3 the joint that is most beyond its bound is held at it, and the others solve
again; 4 what no joint can make up for is scaled. The greatest scale wins.
"""

from __future__ import annotations

import numpy as np

from overreach.arm.spatial.inverse import inverse, rates
from overreach.arm.spatial.screws import Array

SLACK = 1e-12
MORE = 3.0
"""Null rates may be so many times as great as they are wanted."""
LOOSE = 1e-9
"""An excess [1/s] that counts as rounding, of rates that are to fit and of those that cannot be changed."""


def null_share(a: Array, b: Array, c: Array, low: Array, high: Array) -> float:
    """Return the part of the null rates c, as near to 1 as can be, with which a + b + part c fits; -1 if none does.

    Between 0 and MORE: the posture goes its way faster, too, where that keeps a joint off its bound.
    """
    fits = True
    least, most = 0.0, MORE
    for k in range(a.shape[0]):
        whole = a[k] + b[k]
        if whole + c[k] > high[k] + SLACK or whole + c[k] < low[k] - SLACK:
            fits = False
        if abs(c[k]) < LOOSE:
            if whole > high[k] + LOOSE or whole < low[k] - LOOSE:
                most = -1.0
        else:
            one, other = (high[k] - whole) / c[k], (low[k] - whole) / c[k]
            most = min(most, max(one, other))
            least = max(least, min(one, other))
    if fits:
        return 1.0
    return max(least, min(1.0, most)) if most >= least else -1.0


def fit(
    A: Array, w: Array, x: Array, x_c: Array, null: Array, most_null: Array, low: Array, high: Array, soft_low: Array,
    soft_high: Array, eps: float, B: Array, out: Array,
) -> tuple[float, float, int]:  # fmt: skip
    """Write rates for s x + x_c into `out` (n,), within [low, high]; return (s, sigma, the joint that limits or -1).

    x: what may be scaled; x_c: what may not; null: wanted rates of which only what does not move the hand is used, at
    most `most_null` of each joint, and only as far as the rates stay within the soft bounds too, if they can. Where not
    even s = 0 fits, every joint stops, and s is -1. B (m, m): the inverse over all joints.
    """
    m, n = A.shape
    y, of_joints = np.empty(m), np.empty((5, n))
    a, b, c, free, held = of_joints[0], of_joints[1], of_joints[2], of_joints[3], of_joints[4]
    free[:], held[:] = 1.0, 0.0
    sigma = inverse(A, w, free, eps, B)
    rates(A, w, free, B, x, a)
    rates(A, w, free, B, x_c, b)
    for k in range(n):
        c[k] = 0.0
    if n > m:
        for i in range(m):
            total = 0.0
            for k in range(n):
                total -= A[i, k] * null[k]
            y[i] = total
        rates(A, w, free, B, y, c)
        beyond = 1.0
        for k in range(n):
            c[k] += null[k]
            beyond = max(beyond, abs(c[k]) / most_null[k])
        for k in range(n):
            c[k] /= beyond
    part = null_share(a, b, c, soft_low, soft_high)
    if part < 0.0:
        part = null_share(a, b, c, low, high)
    if part >= 0.0:
        for k in range(n):
            out[k] = a[k] + b[k] + part * c[k]
        return 1.0, sigma, -1

    best, limiting, C = -1.0, -1, np.empty((m, m))
    for attempt in range(n - m + 1):
        if attempt > 0:
            inverse(A, w, free, eps, C)
            rates(A, w, free, C, x, a)
            for i in range(m):
                total = x_c[i]
                for k in range(n):
                    if free[k] == 0.0:
                        total -= A[i, k] * held[k]
                y[i] = total
            rates(A, w, free, C, y, b)
            for k in range(n):
                if free[k] == 0.0:
                    b[k] = held[k]
        most, least = 1.0, 0.0
        tight, worst, beyond = -1, -1, 0.0
        for k in range(n):
            if free[k] == 0.0:
                continue
            if abs(a[k]) < SLACK:
                if b[k] > high[k] + LOOSE or b[k] < low[k] - LOOSE:
                    most, tight = -1.0, k
            else:
                one, other = (high[k] - b[k]) / a[k], (low[k] - b[k]) / a[k]
                if max(one, other) < most:
                    most, tight = max(one, other), k
                least = max(least, min(one, other))
            excess = max(a[k] + b[k] - high[k], low[k] - a[k] - b[k])
            if excess > beyond:
                beyond, worst = excess, k
        if most >= least - SLACK and most > best:  # at a bound to the last bit is not beyond it
            best, limiting = max(0.0, most), tight
            for k in range(n):
                out[k] = best * a[k] + b[k]
            if best >= 1.0 - SLACK:
                return 1.0, sigma, -1
        if worst < 0:
            worst = tight
        if worst < 0:
            break
        whole = a[worst] + b[worst]
        held[worst] = high[worst] if whole > high[worst] else low[worst]
        free[worst] = 0.0
    if best < 0.0:
        for k in range(n):
            out[k] = max(low[k], min(high[k], 0.0))
    return best, sigma, limiting
