"""Joint rates for a task by damped least squares, weighted by joint speeds. Scalar: to be compiled.

With the task's Jacobian A (rows, n) and weights w = W^-1 (the squares of the joints' speeds):
    rates = w A^T (A w A^T + lambda^2)^-1 x
sigma, the least singular value of A sqrt(w) [m/s]: the hand can move that fast in any direction at full joint effort.
"""

from __future__ import annotations

import math

import numpy as np

from overreach.arm.spatial.screws import Array

SLIGHT = 1e-12
"""Damping that is always there, as a part of the trace: what is singular to the last bit has an inverse, too."""
TINY = 1e-300
LEAST = 0.03
"""Least lambda, in parts of eps, of an inverse over some joints: so that it is never without."""
DAMPED = 0.75
"""lambda = DAMPED eps (1 - (sigma / eps)^2), where sigma is below eps."""


def gram(A: Array, w: Array, free: Array, G: Array) -> None:
    """Write A w A^T over the joints that are free (1.0, not 0.0) into `G`."""
    rows, n = A.shape
    for i in range(rows):
        for j in range(i + 1):
            total = 0.0
            for k in range(n):
                total += A[i, k] * A[j, k] * w[k] * free[k]
            G[i, j] = total
            G[j, i] = total


def trace(G: Array) -> float:
    """Return the sum of the diagonal."""
    total = 0.0
    for i in range(G.shape[0]):
        total += G[i, i]
    return total


def invert(G: Array, damping: float, L: Array, B: Array) -> None:
    """Write (G + damping I)^-1 into `B`, for a symmetric G >= 0, by Cholesky's factor and its inverse in `L`."""
    m = G.shape[0]
    damping = damping + SLIGHT * trace(G)
    for j in range(m):
        for i in range(j, m):
            total = G[i, j]
            if i == j:
                total += damping
            for k in range(j):
                total -= L[i, k] * L[j, k]
            if i == j:
                L[j, j] = math.sqrt(max(total, TINY))
            else:
                L[i, j] = total / L[j, j]
    for j in range(m):  # the factor's inverse, in its place
        L[j, j] = 1.0 / L[j, j]
        for i in range(j + 1, m):
            total = 0.0
            for k in range(j, i):
                total -= L[i, k] * L[k, j]
            L[i, j] = total / L[i, i]
    for i in range(m):
        for j in range(i + 1):
            total = 0.0
            for k in range(i, m):
                total += L[k, i] * L[k, j]
            B[i, j] = total
            B[j, i] = total


def least(B: Array, C: Array, D: Array) -> float:
    """Return sigma: 1/sqrt of the greatest eigenvalue of B, by its eighth power's greatest column. C, D: scratch."""
    m = B.shape[0]
    scale = trace(B)
    for i in range(m):
        for j in range(m):
            C[i, j] = B[i, j] / scale
    for _ in range(3):
        for i in range(m):
            for j in range(i + 1):
                total = 0.0
                for k in range(m):
                    total += C[i, k] * C[j, k]
                D[i, j] = total
                D[j, i] = total
        for i in range(m):
            for j in range(m):
                C[i, j] = D[i, j]
    best = 0
    for i in range(1, m):
        if C[i, i] > C[best, best]:
            best = i
    square = product = 0.0
    for i in range(m):
        total = 0.0
        for j in range(m):
            total += B[i, j] * C[j, best]
        square += C[i, best] * C[i, best]
        product += C[i, best] * total
    return math.sqrt(square / product)


def damping(sigma: float, eps: float) -> float:
    """Return lambda^2 [m^2/s^2] for a least singular value: none above eps [m/s]."""
    if sigma >= eps:
        return 0.0
    root = DAMPED * eps * (1.0 - (sigma / eps) ** 2)
    return root * root


def surely(B: Array) -> float:
    """Return what sigma is at least, for the inverse B: its greatest eigenvalue is at most its trace."""
    return 1.0 / math.sqrt(trace(B))


def inverse(A: Array, w: Array, free: Array, eps: float, B: Array) -> float:
    """Write the damped (A w A^T)^-1 over free joints into `B`; return sigma before damping.

    Where sigma is surely above eps, what it is at least is returned: that it needs no damping is all there is to know.
    """
    m = A.shape[0]
    scratch = np.empty((3, m, m))
    G, L = scratch[0], scratch[1]
    gram(A, w, free, G)
    invert(G, 0.0, L, B)
    sigma = surely(B)
    if sigma < eps:
        sigma = least(B, scratch[2], L)
        if sigma < eps:
            invert(G, damping(sigma, eps), L, B)
    return sigma


def damping_beside(sigma: float, eps: float) -> float:
    """Return lambda^2 for an inverse over the joints that are free, where sigma is that over all."""
    return max(damping(sigma, eps), (LEAST * eps) ** 2)


def inverse_beside(A: Array, w: Array, free: Array, damped: float, B: Array) -> None:
    """Write the inverse over the joints that are free into `B`, with a damping that is known."""
    m = A.shape[0]
    scratch = np.empty((2, m, m))
    G, L = scratch[0], scratch[1]
    gram(A, w, free, G)
    invert(G, damped, L, B)


def rates(A: Array, w: Array, free: Array, B: Array, x: Array, out: Array) -> None:
    """Write w A^T B x, for the free joints, into `out` (n,); the others get 0."""
    m, n = A.shape
    for k in range(n):
        out[k] = 0.0
    for i in range(m):
        total = 0.0
        for j in range(m):
            total += B[i, j] * x[j]
        for k in range(n):
            out[k] += A[i, k] * total
    for k in range(n):
        out[k] *= w[k] * free[k]
