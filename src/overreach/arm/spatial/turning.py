"""Rotations as nine floats by rows: of the reference and of the hand. Scalar: to be compiled."""

from __future__ import annotations

import math

from overreach.arm.spatial.screws import Array

STRAIGHT = 1e-4
"""Sine of an angle below which the axis of nearly half a turn is taken from the rotation's symmetric part."""


def apart(goal: Array, is_: Array, out: Array) -> float:
    """Write log(goal is_^T) [rad], along the base's axes, into `out` (3,); return its length. Both are (9,)."""
    x = y = z = 0.0
    trace = 0.0
    for k in range(3):
        g0, g1, g2 = goal[k], goal[3 + k], goal[6 + k]
        i0, i1, i2 = is_[k], is_[3 + k], is_[6 + k]
        x += g2 * i1 - g1 * i2
        y += g0 * i2 - g2 * i0
        z += g1 * i0 - g0 * i1
        trace += g0 * i0 + g1 * i1 + g2 * i2
    sine = 0.5 * math.sqrt(x * x + y * y + z * z)
    angle = math.atan2(sine, 0.5 * (trace - 1.0))
    if sine < STRAIGHT and trace < 0.0:
        half_turn(goal, is_, angle, out)
        if out[0] * x + out[1] * y + out[2] * z < 0.0:
            out[0], out[1], out[2] = -out[0], -out[1], -out[2]
        return angle
    factor = 0.5 if sine < 1e-9 else 0.5 * angle / sine
    out[0], out[1], out[2] = factor * x, factor * y, factor * z
    return angle


def half_turn(goal: Array, is_: Array, angle: float, out: Array) -> None:
    """Write the rotation vector of `angle` [rad], near half a turn, from `is_` to `goal` or its opposite into `out`.

    The column of cos I + (1 - cos) a a^T, a the axis, that has the greatest diagonal.
    """
    c = math.cos(angle)
    best, most = 0, -2.0
    for i in range(3):
        own = 0.0
        for k in range(3):
            own += goal[3 * i + k] * is_[3 * i + k]
        if own > most:
            best, most = i, own
    size = 0.0
    for i in range(3):
        both = 0.0
        for k in range(3):
            both += goal[3 * i + k] * is_[3 * best + k] + goal[3 * best + k] * is_[3 * i + k]
        out[i] = 0.5 * both - (c if i == best else 0.0)
        size += out[i] * out[i]
    size = angle / math.sqrt(size)
    out[0], out[1], out[2] = size * out[0], size * out[1], size * out[2]


def yawed(R: Array, yaw: float, out: Array) -> None:
    """Write Rz(yaw) R, yaw [rad], into `out`; both are (9,)."""
    c, s = math.cos(yaw), math.sin(yaw)
    for k in range(3):
        a, b = R[k], R[3 + k]
        out[k], out[3 + k], out[6 + k] = c * a - s * b, s * a + c * b, R[6 + k]
