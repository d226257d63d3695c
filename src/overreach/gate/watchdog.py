"""What is written to a robot when the loop's writes come late, or no longer: the host's last word. Pure.

writes in time --> passed on;  none by the deadline --> ramp;  none for AWAY_S --> latched, until armed anew
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import final

from overreach.gate.guard import Guard
from overreach.types import Channel, Takeover

AWAY_S = 0.1
"""After this long [s] without a write of a loop that was moving the robot, it must arm anew."""
CATCH_UP_S = 0.02
"""However late the host itself is: one step of its ramp is never greater than the acceleration in this time [s]."""

Rates = tuple[float, ...]


@final
class Watchdog:
    """Passes writes on while they are in time; else ramps all channels to zero by one fraction, along the last rates.

    period: of the loop [s]. Give it every write, by `take`, and the time, by `tick`.
    """

    def __init__(self, channels: Sequence[Channel], period: float) -> None:
        self._guard = Guard(channels, period)
        self._period = period
        self._steps = tuple(channel.change_max * period for channel in channels)
        self._due = self._heard = self._at = math.inf  # nothing has been written yet
        self._arms = 0
        self.latched = False
        self._own = False

    @property
    def written(self) -> Rates:
        """The rates that stand, channel by channel."""
        return self._guard.written

    @property
    def resting(self) -> bool:
        """Say whether nothing moves."""
        return not any(self.written)

    @property
    def takeover(self) -> Takeover | None:
        """What the loop must know: None while what it last wrote is what stands."""
        return Takeover(self.written, self.latched) if self._own or self.latched else None

    @property
    def wakes(self) -> float:
        """When to call `tick` next [s], if no write comes: inf if nothing moves."""
        return math.inf if self.resting else max(self._due, self._at + self._period)

    def take(self, rates: Rates, now: float, due: float, arms: int) -> Rates:
        """Return what to write for `rates` that the loop asks for at `now` [s] and that are good until `due` [s].

        arms: how often the loop has been armed: once more releases the latch. What comes past its `due`, or is not
        finite, does not count. After a ramp of its own it goes on from the rates that stand, within the accelerations
        of one period.
        """
        self._look(now)
        if not (now < due and math.isfinite(sum(rates))):
            return self.tick(now) or self.written
        if arms > self._arms:
            self._arms, self.latched = arms, False
        self._heard = now
        if self.latched:
            return self._ramp(now)
        self._due = due
        if self._own:
            rates, self._own = self._towards(rates)
        self._guard.written, self._at = rates, now
        return rates

    def tick(self, now: float) -> Rates | None:
        """Return what to write at `now` [s] because the deadline has passed; None if there is nothing to write."""
        self._look(now)
        if now < self._due or self.resting:
            return None
        return self._ramp(now)

    def end(self, now: float) -> None:
        """Begin to ramp now: there is no loop any more."""
        self._due = min(self._due, now)

    def halt(self) -> None:
        """Take note that the robot was made to stand still."""
        self._guard.restart()

    def _ramp(self, now: float) -> Rates:
        """Return the ramp's next rates, at `now` [s]."""
        self._own = True
        since = now - max(self._at, min(self._due, now))
        self._at = now
        return self._guard.ramp(min(since, CATCH_UP_S)) if since > 0.0 else self.written

    def _look(self, now: float) -> None:
        """Latch if the loop has been away for too long from a robot that moves."""
        if now - self._heard > AWAY_S and (self._own or not self.resting):
            self.latched = True

    def _towards(self, rates: Rates) -> tuple[Rates, bool]:
        """Return the rates on the straight way to `rates` that one period can reach, and whether they fall short."""
        part, short = 1.0, False
        ways = [(was, rate - was, step) for rate, was, step in zip(rates, self.written, self._steps, strict=True)]
        for _, way, step in ways:
            if abs(way) * part > step:
                part, short = step / abs(way), True
        return (tuple([was + way * part for was, way, _ in ways]) if short else rates), short
