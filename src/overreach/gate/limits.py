"""Limits that scale the whole command, so that the hand keeps its direction. Pure functions of floats."""

from __future__ import annotations

import math
from collections.abc import Sequence

from overreach.errors import SetupError
from overreach.types import Record, Verdict

SLACK = 1e-9
"""Relative slack below which a limit does not count as reached."""


class Limits(Record, frozen=True):
    """Limits on the operator's command: v_c [m/s], w_c [rad/s], and their rates dv_c [m/s^2], dw_c [rad/s^2].

    In the frames `base` and `world`, w_c and dw_c limit the second component in [m/s] and [m/s^2].
    """

    v_c: float = 0.4
    w_c: float = 0.4
    dv_c: float = 2.5
    dw_c: float = 2.5

    def __post_init__(self) -> None:
        for name in self.__struct_fields__:
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise SetupError(f"limit {name} must be a finite number > 0, got {value:g}")

    @property
    def ramp_s(self) -> float:
        """The longest ramp of the command to zero [s]."""
        return max(self.v_c / self.dv_c, self.w_c / self.dw_c)


def limit_speed(v_c: float, w_c: float, limits: Limits) -> tuple[float, float, float]:
    """Return (v_c, w_c, scale): the command shrunk, both parts alike, until neither passes its limit."""
    worst = max(abs(v_c) / limits.v_c, abs(w_c) / limits.w_c)
    if worst <= 1.0 + SLACK:
        return v_c, w_c, 1.0
    return v_c / worst, w_c / worst, 1.0 / worst


def slew(now: tuple[float, float], goal: tuple[float, float], limits: Limits, dt: float) -> tuple[float, float, bool]:
    """Return (v_c, w_c, limited): the command moved from `now` towards `goal`, straight, for `dt` [s].

    Both parts take the same fraction of the way, so that a ramp to zero keeps the direction.
    """
    dv = goal[0] - now[0]
    dw = goal[1] - now[1]
    worst = max(abs(dv) / (limits.dv_c * dt), abs(dw) / (limits.dw_c * dt))
    if worst <= 1.0 + SLACK:
        return goal[0], goal[1], False
    return now[0] + dv / worst, now[1] + dw / worst, True


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
    times the period). Where no scale keeps all, the one that is least far out is returned that keeps the speeds; the
    caller then clamps each channel (`clamp_change`). All must be finite.
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


def clamp_change(wanted: float, happening: float, change: float) -> float:
    """Return `wanted` held to within `change` of `happening`: the last word on acceleration."""
    return max(happening - change, min(happening + change, wanted))
