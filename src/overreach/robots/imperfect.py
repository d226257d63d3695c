"""What keeps a real actuator from doing at once what it is told: delay, first-order lag; and noise."""

from __future__ import annotations

import math
import random
from collections import deque

from overreach.errors import SetupError
from overreach.types import Record


class Imperfection(Record, frozen=True):
    """delay_s: dead time of every actuator [s]; lag_s: time constant of its first-order lag [s];
    noise: standard deviation of the measured joint angles [rad]; seed: of the noise.

    All zero: an ideal robot. Raises SetupError if a value is negative or not finite.
    """

    delay_s: float = 0.0
    lag_s: float = 0.0
    noise: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        for name in ("delay_s", "lag_s", "noise"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise SetupError(f"{name} must be a finite number >= 0, got {value:g}")
        if self.noise > math.pi:
            raise SetupError(f"noise must be at most pi rad, got {self.noise:g}")

    @property
    def ideal(self) -> bool:
        """Say whether what is asked for happens at once and is measured as it is."""
        return self.delay_s == 0.0 and self.lag_s == 0.0 and self.noise == 0.0


class Actuators:
    """Rates as they are asked for -> rates as they happen, for any number of channels."""

    def __init__(self, channels: int, imperfection: Imperfection) -> None:
        self._delay = imperfection.delay_s
        self._lag = imperfection.lag_s
        self._queue: deque[tuple[float, tuple[float, ...]]] = deque()
        self._target = (0.0,) * channels
        self.happening = (0.0,) * channels

    @property
    def ideal(self) -> bool:
        """Say whether what is asked for happens at once."""
        return self._delay == 0.0 and self._lag == 0.0

    def ask(self, rates: tuple[float, ...], now: float) -> None:
        """Ask for `rates` from `now` on."""
        if self._delay > 0.0:
            self._queue.append((now + self._delay, rates))
        else:
            self._target = rates
        if self.ideal:
            self.happening = rates

    def next_change(self, now: float, end: float) -> float:
        """Return when, after `now` and by `end`, a delayed request takes effect (else `end`)."""
        while self._queue and self._queue[0][0] <= now:
            self._target = self._queue.popleft()[1]
            if self._lag == 0.0:
                self.happening = self._target
        return min(end, self._queue[0][0]) if self._queue else end

    def advance(self, dt: float) -> tuple[float, ...]:
        """Return the mean rates over the next `dt` [s] and move on by it.

        First-order lag: h(t) = g + (h0 - g) exp(-t/tau), with the mean g + (h0 - g) (1 - exp(-dt/tau)) tau/dt.
        """
        if self._lag == 0.0 or dt <= 0.0:
            return self.happening
        fade = math.exp(-dt / self._lag)
        part = (1.0 - fade) * self._lag / dt
        mean = tuple(goal + (rate - goal) * part for goal, rate in zip(self._target, self.happening, strict=True))
        self.happening = tuple(
            goal + (rate - goal) * fade for goal, rate in zip(self._target, self.happening, strict=True)
        )
        return mean


class JointNoise:
    """Seeded Gaussian noise on measured joint angles."""

    def __init__(self, imperfection: Imperfection) -> None:
        self._sigma = imperfection.noise
        self._random = random.Random(imperfection.seed)

    def measured(self, theta: tuple[float, ...]) -> tuple[float, ...]:
        """Return `theta` [rad] as a noisy encoder would show it."""
        if self._sigma == 0.0:
            return theta
        return tuple(angle + self._random.gauss(0.0, self._sigma) for angle in theta)
