"""Exact integration of the base's motion under a constant twist."""

from __future__ import annotations

from math import cos, sin


def arc(
    x: float, y: float, theta: float, v: float, w: float, dt: float, v_y: float = 0.0
) -> tuple[float, float, float]:
    """Return the base pose (x, y [m], theta [rad]) after `dt` [s] of the twist v [m/s], w [rad/s], v_y to its left.

    The chord of the arc is v dt sinc(h) long and points to theta + h, with h = w dt / 2. Exact for any
    dt; near w = 0 the series of sinc is used, whose next term is below 1e-17 there.
    """
    h = 0.5 * w * dt
    sinc = 1.0 - h * h / 6.0 if -1e-4 < h < 1e-4 else sin(h) / h
    c, s, part = cos(theta + h), sin(theta + h), dt * sinc
    return x + part * (v * c - v_y * s), y + part * (v * s + v_y * c), theta + w * dt
