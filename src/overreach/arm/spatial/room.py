"""How fast each joint may move, and where the posture is drawn to. Scalar: to be compiled.

A row of `limits` is one joint: lower, upper [rad, m], speed [1/s], braking, change of rates [1/s^2], home, weight.
"""

from __future__ import annotations

import math

from overreach.arm.spatial.screws import Array

LOWER, UPPER, SPEED, BRAKING, CHANGE, HOME, WEIGHT, CHANNEL = range(8)
ENDLESS = 100.0
"""Half of a range [rad, m] above which a joint counts as having no limits."""
NEAR_HOME, OFF_LIMITS = 0.3, 1.0
"""Weights of the two parts of the potential."""
NULL_SPEED = 0.5
"""The posture is drawn home with at most this part of any joint's speed, all joints in proportion: each held to its
own, they would go another way, and rest elsewhere than where the workspace was measured."""


def bounds(limits: Array, q: Array, dt: float, margin: float, low: Array, high: Array) -> None:
    """Write the least and greatest rate of each joint: its speed, and what can still brake before its limit.

    rate dt + rate^2/(2 braking) <= distance to the limit less `margin`; backing out is always free.
    """
    for k in range(q.shape[0]):
        speed, braking = limits[k, SPEED], limits[k, BRAKING]
        ahead = limits[k, UPPER] - margin - q[k]
        behind = q[k] - limits[k, LOWER] - margin
        high[k] = 0.0 if ahead <= 0.0 else min(speed, braking * (math.sqrt(dt * dt + 2.0 * ahead / braking) - dt))
        low[k] = 0.0 if behind <= 0.0 else -min(speed, braking * (math.sqrt(dt * dt + 2.0 * behind / braking) - dt))


def downhill(limits: Array, q: Array, gain: float, out: Array) -> None:
    """Write -gain w grad H [1/s]: towards home and away from the limits.

    H = NEAR_HOME/2 sum((q - home)/half)^2 + OFF_LIMITS/8 sum((q - mid)/half)^8, half and mid of each joint's range.
    """
    for k in range(q.shape[0]):
        half = 0.5 * (limits[k, UPPER] - limits[k, LOWER])
        away = q[k] - limits[k, HOME]
        if half > ENDLESS:
            slope = NEAR_HOME * away
        else:
            x = (q[k] - 0.5 * (limits[k, UPPER] + limits[k, LOWER])) / half
            x2 = x * x
            slope = (NEAR_HOME * away / half + OFF_LIMITS * x2 * x2 * x2 * x) / half
        out[k] = -gain * limits[k, WEIGHT] * slope
