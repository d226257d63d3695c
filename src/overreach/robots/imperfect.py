"""Why a real robot neither does at once what it is told, nor reports at once what it does."""

from __future__ import annotations

import math
import random
from collections import deque
from typing import final

import msgspec

from overreach.errors import SetupError
from overreach.types import Record, RobotState


class Imperfection(Record, frozen=True):
    """What is not ideal. All zero (gain 1): an ideal robot.

    Actuators: delay_s: dead time of each [s]; lag_s: time constant of its first-order lag [s]; base_lag_s: the base's,
    if it differs; dead_band: rates [m/s, rad/s] below which nothing moves; gain: what moves, as a fraction of what was
    asked for. Sensors: noise: standard deviation of the measured joint angles [rad]; rate_noise: of
    all measured rates [m/s, rad/s]; feedback_s: period of the reports [s], 0 for one at every read;
    feedback_delay_s: age of a report when it comes [s]; seed: of the noise. Raises SetupError if a value is negative or
    not finite.
    """

    delay_s: float = 0.0
    lag_s: float = 0.0
    noise: float = 0.0
    seed: int = 0
    base_lag_s: float | None = None
    dead_band: tuple[float, float] = (0.0, 0.0)
    gain: float = 1.0
    rate_noise: float = 0.0
    feedback_s: float = 0.0
    feedback_delay_s: float = 0.0

    def __post_init__(self) -> None:
        for name in ("delay_s", "lag_s", "noise", "gain", "rate_noise", "feedback_s", "feedback_delay_s"):
            _check(name, getattr(self, name))
        _check("base_lag_s", self.base_lag_s or 0.0)
        for rate in self.dead_band:
            _check("dead_band", rate)
        if self.noise > math.pi:
            raise SetupError(f"noise must be at most pi rad, got {self.noise:g}")

    @property
    def ideal(self) -> bool:
        """Say whether every request takes effect at once and is measured exactly."""
        return _but_the_seed(self) == IDEAL

    def lags(self, channels: int, axes: int) -> tuple[float, ...]:
        """Return the time constant of each channel [s]; the first `axes` are the base's."""
        base = self.lag_s if self.base_lag_s is None else self.base_lag_s
        return (*(base,) * axes, *(self.lag_s,) * (channels - axes))


def _but_the_seed(imperfection: Imperfection) -> tuple[object, ...]:
    delay, lag, noise, _seed, *others = msgspec.structs.astuple(imperfection)
    return delay, lag, noise, *others


def _check(name: str, value: float) -> None:
    if not (math.isfinite(value) and value >= 0.0):
        raise SetupError(f"{name} must be a finite number >= 0, got {value:g}")


IDEAL = _but_the_seed(Imperfection())


@final
class Actuators:
    """Rates asked for -> actual rates, for any number of channels; the first `axes` are the base's, turning last."""

    def __init__(self, channels: int, imperfection: Imperfection, axes: int = 2) -> None:
        self._delay = imperfection.delay_s
        self._lags = imperfection.lags(channels, axes)
        self._lagging = any(self._lags)
        forward, turning = imperfection.dead_band
        self._dead = (*(forward,) * (axes - 1), *(turning,) * (channels - axes + 1))
        self._gain = imperfection.gain
        self._queue: deque[tuple[float, tuple[float, ...]]] = deque()
        self._target = (0.0,) * channels
        self.happening = (0.0,) * channels

    @property
    def ideal(self) -> bool:
        """Say whether every request takes effect at once."""
        return self._delay == 0.0 and not self._lagging

    def ask(self, rates: tuple[float, ...], now: float) -> None:
        """Ask for `rates` from `now` on."""
        if self._gain != 1.0 or any(self._dead):
            rates = tuple(
                0.0 if abs(rate) < least else self._gain * rate for rate, least in zip(rates, self._dead, strict=True)
            )
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
            if not self._lagging:
                self.happening = self._target
        return min(end, self._queue[0][0]) if self._queue else end

    def advance(self, dt: float) -> tuple[float, ...]:
        """Return the mean rates over the next `dt` [s], and advance by it.

        First-order lag: h(t) = g + (h0 - g) exp(-t/tau), with the mean g + (h0 - g) (1 - exp(-dt/tau)) tau/dt.
        """
        if not self._lagging or dt <= 0.0:
            return self.happening
        mean, after = [], []
        for goal, rate, lag in zip(self._target, self.happening, self._lags, strict=True):
            if lag == 0.0:
                mean.append(goal)
                after.append(goal)
                continue
            fade = math.exp(-dt / lag)
            part = (1.0 - fade) * lag / dt
            mean.append(goal + (rate - goal) * part)
            after.append(goal + (rate - goal) * fade)
        self.happening = tuple(after)
        return tuple(mean)


@final
class Sensors:
    """True states -> reported states: noisy, periodic, late. omni: whether the base's sideways rate is measured."""

    def __init__(self, imperfection: Imperfection, now: float, omni: bool = False) -> None:
        self._omni = omni
        self._noise = imperfection.noise
        self._rate_noise = imperfection.rate_noise
        self._random = random.Random(imperfection.seed)
        self._every = imperfection.feedback_s
        self._delay = imperfection.feedback_delay_s
        self._next = now
        self._coming: deque[RobotState] = deque()
        self._last: RobotState | None = None

    def due(self, end: float) -> float:
        """Return the next time, up to `end`, at which the state is sampled (else `end`)."""
        return min(end, self._next) if self._every > 0.0 else end

    def see(self, state: RobotState) -> None:
        """Sample the true `state` at its time; if no sample is due, do nothing."""
        if self._every > 0.0:
            if state.t < self._next:
                return
            self._next += self._every
        if self._every > 0.0 or self._delay > 0.0:
            self._coming.append(self._noisy(state))

    def report(self, state: RobotState, now: float) -> RobotState:
        """Return what is read at `now` [s] while the true state is `state`."""
        if self._every == 0.0 and self._delay == 0.0:
            return self._noisy(state)
        while self._coming and self._coming[0].t + self._delay <= now:
            self._last = self._coming.popleft()
        # Before the first report, assume that the robot has always stood there.
        return self._last or msgspec.structs.replace(self._coming[0] if self._coming else state, t=now - self._delay)

    def _noisy(self, state: RobotState) -> RobotState:
        if self._noise == 0.0 and self._rate_noise == 0.0:
            return state
        return msgspec.structs.replace(
            state,
            q=self._with_noise(state.q, self._noise),
            dq=self._with_noise(state.dq, self._rate_noise),
            motion=msgspec.structs.replace(
                state.motion,
                v_x=self._with_noise((state.v_b,), self._rate_noise)[0],
                v_y=self._with_noise((state.motion.v_y,), self._rate_noise)[0] if self._omni else state.motion.v_y,
                w_z=self._with_noise((state.w_b,), self._rate_noise)[0],
            ),
        )

    def _with_noise(self, values: tuple[float, ...], sigma: float) -> tuple[float, ...]:
        return tuple(value + self._random.gauss(0.0, sigma) for value in values) if sigma > 0.0 else values
