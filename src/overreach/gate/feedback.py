"""Checks of what a robot reports, before anything is decided from it: finite, in range, alive, following? Pure.

state --> finite? in range? newer? moved when asked? as fast as asked? --> believed, or a fault with its reason
"""

from __future__ import annotations

import math
from cmath import isfinite
from collections.abc import Sequence
from typing import final

from overreach.gate.asked import Asked
from overreach.types import Channel

BEYOND = {"rad": 0.05, "m": 0.02}
"""A joint that reads this far past its limit [rad, m] is out of range ..."""
TOO_FAST = 2.0
"""... and so is a rate that reads this many times its limit."""
FROZEN_S = 0.1
"""Within this time [s] the robot's own time must advance, and a position that was asked to move enough must change."""
FROZEN_STEPS = 3.0
"""A position counts as frozen once it owes more than this many steps of its resolution."""
OLD_S = 1.0
"""A report older than this [s] is a fault ..."""
AHEAD_S = 0.1
"""... and so is one that is farther ahead than this [s]."""
TOLERANCE = {"m": 0.1, "rad": 0.2}
"""A rate follows if it is within this [m/s, rad/s] of what was asked for ..."""
TOLERANCE_PART = 0.3
"""... or within this fraction of it."""
FOLLOW_S = 0.3
"""How long [s] a rate may be farther off than that."""
SLOWEST = 1.5
"""Only a rate above this many dead bands is certain to move anything."""

Position = float | complex
"""What a channel's rate moves; complex if that is a point in the plane."""


@final
class Feedback:
    """Checks each report of a robot against what was asked of it; see the thresholds above.

    A rate follows if it lies, within the tolerance, between the request itself and the request through a lag of 0.3 s.
    `asked` holds both, for the time of the newest report.
    """

    def __init__(self, channels: Sequence[Channel]) -> None:
        self._channels = tuple(channels)
        self.asked = Asked(len(self._channels))
        self._ranges = [
            (k, channel.lower - BEYOND[channel.unit], channel.upper + BEYOND[channel.unit], TOO_FAST * channel.rate_max)
            for k, channel in enumerate(self._channels)
        ]
        self._thresholds = [
            (k, TOLERANCE[channel.unit], SLOWEST * channel.dead_band, FROZEN_STEPS * channel.resolution)
            for k, channel in enumerate(self._channels)
        ]
        self.restart()

    def restart(self) -> None:
        """Forget the past: the robot was put somewhere else, at rest."""
        self.asked.restart()
        self.reset()

    def reset(self) -> None:
        """Start every check afresh, but keep what was asked for: a fault was reset."""
        n = len(self._channels)
        self.asked.reset()
        self.stamp = -math.inf
        """Time of the newest report that was believed [s]."""
        self._came_at = math.inf
        self._positions: list[Position | None] = [None] * n
        self._changed_at = [math.inf] * n
        self._owed = [math.inf] * n
        self._off_since = [math.inf] * n

    def check(self, t: float, positions: Sequence[Position], rates: Sequence[float], now: float) -> str:
        """Return what is wrong with a report for time `t` [s], read at `now` [s] on the same clock; "" if nothing is.

        positions [m, rad] and rates [m/s, rad/s]: one per channel.
        """
        if not math.isfinite(t):
            return "The robot's feedback has no finite time."
        for (k, least, most, fastest), position, rate in zip(self._ranges, positions, rates, strict=True):
            if not (least <= position.real <= most and -fastest <= rate <= fastest and isfinite(position)):
                return self._why_not(k, position, rate)
        if t <= self.stamp:
            if now - self._came_at > FROZEN_S:
                return f"The robot's feedback is frozen: its time has not advanced for {FROZEN_S:g} s."
            return ""
        if not -AHEAD_S <= now - t <= OLD_S:
            return f"The robot's feedback is of another time: {t - now:+.3g} s from now."
        passed = t - self.stamp
        self.stamp = t
        self._came_at = now
        self.asked.move_to(t)
        return self._follows(t, passed, positions, rates)

    def _follows(self, t: float, passed: float, positions: Sequence[Position], rates: Sequence[float]) -> str:
        """Return which channel does not do what was asked of it, and how; or ""."""
        asked, lagged = self.asked.in_force, self.asked.lagged
        for k, tolerance, slowest, owed in self._thresholds:
            at_once, slowly, position, rate = asked[k], lagged[k], positions[k], rates[k]
            low, high = (at_once, slowly) if at_once < slowly else (slowly, at_once)
            wide = max(tolerance, TOLERANCE_PART * high, -TOLERANCE_PART * low)
            if low - wide <= rate <= high + wide:
                self._off_since[k] = math.inf
            else:
                self._off_since[k] = min(self._off_since[k], t)
                if t - self._off_since[k] > FOLLOW_S:
                    return self._not_following(k, rate)
            if position != self._positions[k]:
                self._positions[k] = position
                self._changed_at[k] = t
                self._owed[k] = 0.0
            elif not -slowest <= at_once <= slowest:
                self._owed[k] += min(abs(at_once), abs(slowly)) * passed
                if self._owed[k] > owed and t - self._changed_at[k] > FROZEN_S:
                    moves = self._channels[k].moves
                    return f"The robot's feedback is frozen: {moves} does not change, though it was asked to."
        return ""

    def _why_not(self, k: int, position: Position, rate: float) -> str:
        channel = self._channels[k]
        if not isfinite(position):
            return f"The robot's feedback of {channel.moves} is not finite."
        if not math.isfinite(rate):
            return f"The robot's feedback of {channel.name} is not finite."
        if abs(rate) > TOO_FAST * channel.rate_max:
            return f"The robot's feedback of {channel.name} is out of range: {rate:.4g} {channel.unit}/s."
        return f"The robot's feedback of {channel.moves} is out of range: {position.real:.4g} {channel.unit}."

    def _not_following(self, k: int, rate: float) -> str:
        channel = self._channels[k]
        return (
            f"The robot does not follow: {channel.name} is {rate:.2g} {channel.unit}/s, "
            f"{self.asked.in_force[k]:.2g} was asked for."
        )
