"""Limits that scale the whole command, so that the hand keeps its direction. Pure functions of floats."""

from __future__ import annotations

import math
from collections.abc import Sequence
from math import hypot
from operator import add, sub

from msgspec.structs import astuple

from overreach.errors import SetupError
from overreach.types import Record, Twist
from overreach.verdicts import Verdict

SLACK = 1e-9
"""Relative slack below which a limit does not count as reached."""


class Limits(Record, frozen=True):
    """Limits on the operator's command and on its rates of change.

    v_c [m/s]: on the hand's speed along the ground; v_z [m/s]: on its speed up and down; w_c [rad/s]: on its turning
    rate about any axis; dv_c, dv_z [m/s^2], dw_c [rad/s^2]: on their rates of change.
    """

    v_c: float = 0.4
    w_c: float = 0.4
    dv_c: float = 2.5
    dw_c: float = 2.5
    v_z: float = 0.1
    dv_z: float = 0.625

    def __post_init__(self) -> None:
        for name in self.__struct_fields__:
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise SetupError(f"limit {name} must be a finite number > 0, got {value:g}")

    @property
    def ramp_s(self) -> float:
        """The longest ramp of the command to zero [s]."""
        return max(self.v_c / self.dv_c, self.w_c / self.dw_c, self.v_z / self.dv_z)


def _worst(twist: Twist, along: float, up: float, turning: float) -> float:
    """Return the greatest ratio of a part of the twist to its bound."""
    v_x, v_y, v_z, w_x, w_y, w_z = astuple(twist)
    worst: float = max(hypot(v_x, v_y) / along, abs(v_z) / up, hypot(w_x, w_y, w_z) / turning)
    return worst


def limit_speed(twist: Twist, limits: Limits) -> tuple[Twist, float]:
    """Return (twist, scale): the command with all parts scaled alike, so that none passes its limit."""
    worst = _worst(twist, limits.v_c, limits.v_z, limits.w_c)
    if worst <= 1.0 + SLACK:
        return twist, 1.0
    return Twist(*[part / worst for part in astuple(twist)]), 1.0 / worst


def slew(now: Twist, goal: Twist, limits: Limits, dt: float) -> tuple[Twist, bool]:
    """Return (twist, limited): the command moved straight from `now` towards `goal` for `dt` [s].

    All parts take the same fraction of the way, so that a ramp to zero keeps the direction.
    """
    if now == goal:
        return goal, False
    way = Twist(*map(sub, astuple(goal), astuple(now)))
    worst = _worst(way, limits.dv_c * dt, limits.dv_z * dt, limits.dw_c * dt)
    if worst <= 1.0 + SLACK:
        return goal, False
    return Twist(*map(add, astuple(now), [part / worst for part in astuple(way)])), True


def feasible_scale(
    wanted: Sequence[float],
    happening: Sequence[float],
    fastest: Sequence[float],
    change: Sequence[float],
    apart: Sequence[float] | None = None,
) -> tuple[float, Verdict]:
    """Return the greatest scale in [0, 1] of a command that keeps every limit, and why.

    At scale s the rate of channel i is s wanted_i + apart_i, where `apart` (none by default) is what a channel does
    whatever the command is. It must satisfy |rate_i| <= fastest_i and |rate_i - happening_i| <= change_i (acceleration
    times the period). If no scale keeps every limit, return the one that keeps the speed limits and is least far out
    of the others; the caller then clamps each channel (`clamp_change`). All arguments must be finite.
    """
    scale = 1.0
    verdict = Verdict.MOVING
    rest = apart or (0.0,) * len(wanted)
    for rate, own, most in zip(wanted, rest, fastest, strict=True):
        along = own if rate > 0.0 else -own
        if rate != 0.0 and abs(rate) * scale + along > most * (1.0 + SLACK):
            scale = (most - along) / abs(rate)
            verdict = Verdict.SPEED
    low, high = -math.inf, scale
    for rate, own, was, step in zip(wanted, rest, happening, change, strict=True):
        if abs(rate) > SLACK:
            one, other = (was - own - step) / rate, (was - own + step) / rate
            low = max(low, min(one, other))
            high = min(high, max(one, other))
    if high < scale - SLACK:
        verdict = Verdict.ACCELERATION
    if low > high:
        high = 0.5 * (low + high)
        verdict = Verdict.ACCELERATION
    return max(0.0, min(scale, high)), verdict


def within(rates: Sequence[float], was: Sequence[float], most: Sequence[float], change: Sequence[float]) -> bool:
    """Say whether every rate keeps its limit and so does its change since `was`. False for NaN."""
    for rate, before, top, step in zip(rates, was, most, change, strict=True):
        if not (-top <= rate <= top and before - step <= rate <= before + step):
            return False
    return True


def clamp_change(wanted: float, happening: float, change: float) -> float:
    """Return `wanted` held to within `change` of `happening`: the last word on acceleration."""
    return max(happening - change, min(happening + change, wanted))
