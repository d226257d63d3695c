"""The twin of `room` for a step with numpy: in lists of floats, which for so few are faster."""

from __future__ import annotations

import math

from overreach.arm.spatial.lean_fit import Floats
from overreach.arm.spatial.room import ENDLESS, NEAR_HOME, OFF_LIMITS


def joint_of(limits: Floats, margin: float, gain: float) -> tuple[float, ...]:
    """Return what `room` needs of one joint."""
    lower, upper, speed, braking, change, home, weight = limits
    half = 0.5 * (upper - lower)
    endless = half > ENDLESS
    half = 1.0 if endless else half
    return (
        lower + margin, upper - margin, speed, braking, change, home, 0.5 * (lower + upper), half,
        0.0 if endless else OFF_LIMITS, -gain * weight / half, speed * speed / (2.0 * braking),
    )  # fmt: skip


def room(
    joints: list[tuple[float, ...]], q: Floats, rates: Floats, dt: float
) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
    """Return low, high of `room.bounds`, both within what can change, `room.downhill`, and the greatest changes."""
    lows, highs, soft_lows, soft_highs, nulls, changes = [], [], [], [], [], []
    square = dt * dt
    for (first, last, speed, braking, change, home, middle, half, off, pull, way), x, before in zip(
        joints, q, rates, strict=True
    ):
        ahead, behind, free = last - x, x - first, speed * dt + way
        high, low = speed, -speed
        if ahead < free:  # nearer to the limit than the way that it takes to stop
            high = braking * (math.sqrt(square + 2.0 * ahead / braking) - dt) if ahead > 0.0 else 0.0
        if behind < free:
            low = -braking * (math.sqrt(square + 2.0 * behind / braking) - dt) if behind > 0.0 else 0.0
        most = change * dt
        y = (x - middle) / half
        y2 = y * y
        lows.append(low)
        highs.append(high)
        soft_lows.append(low if low > before - most else before - most)
        soft_highs.append(high if high < before + most else before + most)
        nulls.append(pull * (NEAR_HOME * (x - home) / half + off * y2 * y2 * y2 * y))
        changes.append(most)
    return lows, highs, soft_lows, soft_highs, nulls, changes


def within(rates: Floats, low: Floats, high: Floats, was: Floats, change: Floats) -> Floats:
    """Return rates held to their bounds, then to how much they can change."""
    held = []
    for one, a, b, before, most in zip(rates, low, high, was, change, strict=True):
        x = a if one < a else b if one > b else one
        held.append(before - most if x < before - most else before + most if x > before + most else x)
    return held
