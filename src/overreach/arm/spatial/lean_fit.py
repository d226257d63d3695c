"""The twin of `fit` with numpy: the same rates to 1e-9. Bounds are lists of floats: for so few, they are faster."""

from __future__ import annotations

import math
from operator import add
from typing import Any, final

import numpy as np

from overreach.arm.spatial.fit import LOOSE, MORE, SLACK
from overreach.arm.spatial.inverse import SLIGHT, damping, damping_beside
from overreach.arm.spatial.screws import Array

Floats = list[float]


@final
class Fit:
    """See `fit`, for one A: the inverse over all joints is made once."""

    def __init__(
        self,
        A: Array,
        w: Array,
        null: Floats,
        most_null: Floats,
        low: Floats,
        high: Floats,
        soft_low: Floats,
        soft_high: Floats,
        eps: float,
    ) -> None:
        self._A, self._w, self._eps = A, w, eps
        self._bounds, self._soft = (low, high), (soft_low, soft_high)
        A_w = A * w
        B, self.sigma = _inverse(A_w @ A.T, eps)
        self._P = P = A_w.T @ B
        m, n = A.shape
        self._c: Floats = [0.0] * n
        if n > m:
            wanted = np.array(null)
            c = (wanted - P @ (A @ wanted)).tolist()
            beyond = max(1.0, *[abs(one) / most for one, most in zip(c, most_null, strict=True)])
            self._c = [one / beyond for one in c]

    def more(self, x: Floats, free: list[bool] | None) -> Floats:
        """Return rates for x: of all joints or, damped a little, of those that are free."""
        if free is None:
            return (self._P @ np.array(x)).tolist()  # type: ignore[no-any-return]  # numpy does not say of what
        A_w = self._A * (self._w * np.array(free, float))
        G = A_w @ self._A.T
        G.flat[:: G.shape[0] + 1] += damping_beside(self.sigma, self._eps) + SLIGHT * _trace(G)
        return (A_w.T @ np.linalg.solve(G, x)).tolist()  # type: ignore[no-any-return]  # as above

    def fit(self, x: Floats, x_c: Floats) -> tuple[float, int, Floats]:
        """Return (s, the joint that limits or -1, rates)."""
        a, b = (self._P @ np.array((x, x_c)).T).T.tolist()
        whole = list(map(add, a, b))
        part = _null_share(whole, self._c, *self._soft)
        if part < 0.0:
            part = _null_share(whole, self._c, *self._bounds)
        if part >= 0.0:
            return 1.0, -1, [now + part * more for now, more in zip(whole, self._c, strict=True)]
        return self._saturated(np.array(x), np.array(x_c), np.array(a), np.array(b))

    def _saturated(self, x: Array, x_c: Array, a: Array, b: Array) -> tuple[float, int, Floats]:
        A, (low, high) = self._A, self._bounds
        m, n = A.shape
        free, held, out = np.ones(n), np.zeros(n), np.zeros(n)
        best, limiting = -1.0, -1
        for attempt in range(n - m + 1):
            if attempt > 0:
                A_w = A * (self._w * free)
                P = A_w.T @ _inverse(A_w @ A.T, self._eps)[0]
                a, b = P @ x, P @ (x_c - A @ held)
                b = np.where(free == 0.0, held, b)
            most, least, tight, worst, beyond = 1.0, 0.0, -1, -1, 0.0
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
            if most >= least - SLACK and most > best:
                best, limiting = max(0.0, most), tight
                out = best * a + b
                if best >= 1.0 - SLACK:
                    return 1.0, -1, out.tolist()
            if worst < 0:
                worst = tight
            if worst < 0:
                break
            whole = a[worst] + b[worst]
            held[worst] = high[worst] if whole > high[worst] else low[worst]
            free[worst] = 0.0
        if best < 0.0:
            out = np.maximum(low, np.minimum(high, 0.0))
        return best, limiting, out.tolist()


def _null_share(whole: Floats, c: Floats, low: Floats, high: Floats) -> float:
    """See `fit.null_share`; whole: a + b."""
    for now, more, below, above in zip(whole, c, low, high, strict=True):
        if now + more > above + SLACK or now + more < below - SLACK:
            break
    else:
        return 1.0
    least, most = 0.0, MORE
    for now, slope, below, above in zip(whole, c, low, high, strict=True):
        if abs(slope) < LOOSE:
            if now > above + LOOSE or now < below - LOOSE:
                return -1.0
        else:
            one, other = (above - now) / slope, (below - now) / slope
            most, least = min(most, max(one, other)), max(least, min(one, other))
    return max(least, min(1.0, most)) if most >= least else -1.0


def _inverse(G: Array, eps: float) -> tuple[Array, float]:
    """Return the damped inverse of G and sigma; see `inverse.inverse`."""
    G.flat[:: G.shape[0] + 1] += SLIGHT * _trace(G)
    B: Any = np.linalg.inv(G)
    trace = _trace(B)
    sigma = 1.0 / math.sqrt(trace)
    if sigma < eps:
        C = B / trace
        C = C @ C
        C = C @ C
        C = C @ C
        v = C[:, int(C.diagonal().argmax())]
        sigma = math.sqrt(float(v @ v) / float(v @ (B @ v)))
        if sigma < eps:
            G.flat[:: G.shape[0] + 1] += damping(sigma, eps)
            B = np.linalg.inv(G)
    return B, sigma


def _trace(G: Array) -> float:
    return float(sum(G.diagonal().tolist()))  # quicker than numpy's own for so few
