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


def rotation(x: float, y: float, z: float, out: Array) -> None:
    """Write the rotation by the vector (x, y, z) [rad] into `out` (9,)."""
    square = x * x + y * y + z * z
    if square < SLIGHT:
        a, b = 1.0 - square / 6.0, 0.5 - square / 24.0
    else:
        angle = math.sqrt(square)
        a, b = math.sin(angle) / angle, (1.0 - math.cos(angle)) / square
    out[0], out[4], out[8] = 1.0 - b * (y * y + z * z), 1.0 - b * (x * x + z * z), 1.0 - b * (x * x + y * y)
    out[1], out[3] = b * x * y - a * z, b * x * y + a * z
    out[2], out[6] = b * x * z + a * y, b * x * z - a * y
    out[5], out[7] = b * y * z - a * x, b * y * z + a * x


def turned_on(R: Array, yaw: float, w: Array, spin: float, approach: Array, dt: float, E: Array, out: Array) -> None:
    """Write exp(dt w') R exp(dt spin a) into `out`: R (9,), turned at w [rad/s] (3,), and about its own axis a.

    w' is w seen from axes that are turned by `yaw` [rad]; E (9,) is overwritten.
    """
    for i in range(9):
        out[i] = R[i]
    if w[0] != 0.0 or w[1] != 0.0 or w[2] != 0.0:
        c, s = math.cos(yaw), math.sin(yaw)
        rotation(dt * (c * w[0] + s * w[1]), dt * (c * w[1] - s * w[0]), dt * w[2], E)
        for k in range(3):
            a, b, d = out[k], out[3 + k], out[6 + k]
            for i in range(3):
                out[3 * i + k] = E[3 * i] * a + E[3 * i + 1] * b + E[3 * i + 2] * d
    if spin != 0.0:
        rotation(dt * spin * approach[0], dt * spin * approach[1], dt * spin * approach[2], E)
        for i in range(3):
            a, b, d = out[3 * i], out[3 * i + 1], out[3 * i + 2]
            for k in range(3):
                out[3 * i + k] = a * E[k] + b * E[3 + k] + d * E[6 + k]


SLIGHT = 1e-8
"""Square of an angle [rad^2] below which its sine is taken by the series."""


def yawed(R: Array, yaw: float, out: Array) -> None:
    """Write Rz(yaw) R, yaw [rad], into `out`; both are (9,)."""
    c, s = math.cos(yaw), math.sin(yaw)
    for k in range(3):
        a, b = R[k], R[3 + k]
        out[k], out[3 + k], out[6 + k] = c * a - s * b, s * a + c * b, R[6 + k]
