"""What a robot was asked for, and when, to compare with what it reports for the same time. Pure."""

from __future__ import annotations

import math
from collections import deque
from typing import final

LAG_S = 0.3
"""Time constant [s] of the slowest robot that still counts as following."""

Rates = tuple[float, ...]


@final
class Asked:
    """The rates in force at the time of the newest report: as asked for, and through a first-order lag.

    in_force: the rates last asked for before that time; lagged: the response of dx/dt = (in_force - x)/LAG_S to them.
    """

    def __init__(self, channels: int) -> None:
        self._zero = (0.0,) * channels
        self.restart()

    def restart(self) -> None:
        """Forget the past: the robot is at rest."""
        self.in_force = self.lagged = self._last = self._zero
        self._later: deque[tuple[float, Rates]] = deque()
        self._t: float | None = None

    def reset(self) -> None:
        """Keep what was asked for; the next report may be of any time."""
        self._t = None

    def add(self, rates: Rates, t: float) -> None:
        """Note that `rates` are asked for from `t` [s] on."""
        if rates != self._last:
            self._later.append((t, rates))
            self._last = rates

    def move_to(self, t: float) -> None:
        """Advance to the time `t` [s] of a newer report. What was asked for at `t` itself came after that report."""
        while self._later and self._later[0][0] < t:
            at, rates = self._later.popleft()
            self._lag_to(at)
            self.in_force = rates
        self._lag_to(t)

    def _lag_to(self, t: float) -> None:
        if self._t is None:
            self._t = t
        elif t > self._t:
            fade = math.exp((self._t - t) / LAG_S)
            self._t = t
            if self.lagged != self.in_force:
                self.lagged = tuple(
                    [goal + (rate - goal) * fade for goal, rate in zip(self.in_force, self.lagged, strict=True)]
                )
