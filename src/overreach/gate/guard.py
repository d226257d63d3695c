"""The last word before the motors, over n named channels, base rates first. It knows no robot and no law. Pure.

what is wanted --> finite? bounded? may anything move? --> what is written
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from operator import truediv
from typing import final

from overreach.gate.limits import within
from overreach.types import Channel
from overreach.verdicts import Motion

SLACK = 1e-6
"""An excess over a bound that counts as rounding and is cut off, as a fraction of the change in one period."""


@final
class Guard:
    """Whatever is wanted: what is written is finite, keeps every bound, and is zero when nothing may move.

    channels: |rate| <= rate_max, and |change| <= change_max dt from one write to the next. Wanting more is a
    fault: it is latched with its reason, and the whole robot ramps to zero along its own direction from what was last
    written. ramp_s [s]: duration of the command's own ramp; stop_s [s]: the greater of ramp_s and the longest ramp of a
    channel. From the moment that nobody moves the hand, the robot is at zero within stop_s plus one period.
    """

    def __init__(self, channels: Sequence[Channel], ramp_s: float) -> None:
        self.channels = tuple(channels)
        self._changes = tuple(channel.change_max for channel in self.channels)
        self._mosts = tuple(channel.rate_max for channel in self.channels)
        self.stop_s = max(ramp_s, *(channel.rate_max / channel.change_max for channel in self.channels))
        self._dt: float | None = None
        self._steps: tuple[float, ...] = ()
        self.fault = ""
        """Why the robot must stand still until `reset`; empty if there is no fault."""
        self.restart()

    def restart(self) -> None:
        """Begin from standstill. A fault stays."""
        self.written = (0.0,) * len(self.channels)
        self._let_go_s = math.inf  # nobody has moved the hand yet

    def latch(self, reason: str) -> None:
        """Latch a fault for `reason`; the first one stays."""
        self.fault = self.fault or reason

    def reset(self) -> None:
        """Release the latch. Moves nothing."""
        self.fault = ""

    def write(self, wanted: Sequence[float], motion: Motion, dt: float) -> tuple[float, ...]:
        """Return the rates to write for the period `dt` [s], given the rates `wanted` and the gate's `motion`."""
        self._let_go_s = 0.0 if motion is Motion.ALLOWED else self._let_go_s + dt
        if motion is Motion.NONE:
            if not all(map(math.isfinite, wanted)):
                self.latch(self._not_finite(wanted))
        elif not self.fault:
            bounded = self._bounded(wanted, dt)
            in_time = motion is Motion.ALLOWED or self._ramp_s() <= self.stop_s - self._let_go_s
            if bounded is not None and in_time:
                self.written = bounded
                return bounded
        return self.ramp(dt)

    def ramp(self, dt: float) -> tuple[float, ...]:
        """Return the next rates of the ramp from what was last written to zero: all channels shrink by one fraction."""
        periods = max(1.0, self._ramp_s() / dt)
        self.written = tuple(rate - rate / periods for rate in self.written)
        return self.written

    def _ramp_s(self) -> float:
        """Return how long a ramp from what was last written takes [s]."""
        longest: float = max(map(truediv, map(abs, self.written), self._changes))
        return longest

    def _bounded(self, wanted: Sequence[float], dt: float) -> tuple[float, ...] | None:
        """Return `wanted` less any rounding excess; None, with a fault latched, if it passes a bound."""
        if dt != self._dt:
            self._dt, self._steps = dt, tuple([change * dt for change in self._changes])
        if within(wanted, self.written, self._mosts, self._steps):
            return tuple(wanted)
        out: list[float] = []
        for rate, was, most, change in zip(wanted, self.written, self._mosts, self._steps, strict=True):
            held = min(most, was + change, max(-most, was - change, rate))
            if not abs(rate - held) <= SLACK * change:  # so that NaN is caught as well
                k = len(out)
                finite = math.isfinite(rate)
                self.latch(self._trespass(rate, was, self.channels[k], dt) if finite else self._not_finite(wanted))
                return None
            out.append(held)
        return tuple(out)

    def _not_finite(self, wanted: Sequence[float]) -> str:
        first = next(k for k, rate in enumerate(wanted) if not math.isfinite(rate))
        return f"{self.channels[first].name} was to be written as a value that is not finite."

    @staticmethod
    def _trespass(rate: float, was: float, channel: Channel, dt: float) -> str:
        name, unit, most = channel.name, channel.unit, channel.rate_max
        if abs(rate) > most:
            return f"{name} was to be written as {rate:.3g} {unit}/s; its limit is {most:.3g}."
        change = abs(rate - was) / dt
        return f"{name} was to be changed by {change:.3g} {unit}/s^2; its limit is {channel.change_max:.3g}."
