"""The last word before the motors. Over n named channels, base rates first; it knows no robot and no law. Pure.

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
"""Excess over a bound, in parts of the change in one period, that is taken for rounding and taken away."""


@final
class Guard:
    """Whatever is wanted: what is written is finite, keeps every bound, and is zero when nothing may move.

    channels: |rate| <= rate_max, and |change| <= change_max dt from one write to the next. What is wanted beyond that
    is a fault: it is latched with its reason, and the whole robot ramps to zero along its own direction from what was
    last written. ramp_s [s]: how long the command's own ramp takes; stop_s [s]: that, or the longest ramp of a channel
    where it is longer. From the moment that nobody moves the hand, the robot is at zero within stop_s and a period.
    """

    def __init__(self, channels: Sequence[Channel], ramp_s: float) -> None:
        self.channels = tuple(channels)
        self._changes = tuple(channel.change_max for channel in self.channels)
        self._mosts = tuple(channel.rate_max for channel in self.channels)
        self.stop_s = max(ramp_s, *(channel.rate_max / channel.change_max for channel in self.channels))
        self._dt = 0.0
        self._steps: tuple[float, ...] = ()
        self.fault = ""
        """Why the robot is to stand still until `reset`; empty where it is not."""
        self.restart()

    def restart(self) -> None:
        """Begin from standstill. A fault stays."""
        self.written = (0.0,) * len(self.channels)
        self._let_go_s = math.inf  # for as long as there has been a robot

    def latch(self, reason: str) -> None:
        """Latch a fault for `reason`; the first one stays."""
        self.fault = self.fault or reason

    def reset(self) -> None:
        """Release the latch. Moves nothing."""
        self.fault = ""

    def write(self, wanted: Sequence[float], motion: Motion, dt: float) -> tuple[float, ...]:
        """Return what to write for the period `dt` [s], for the rates `wanted` and what the gate says of motion."""
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
        """Return the next rates on the way from what was last written to zero, all channels by the same fraction."""
        periods = max(1.0, self._ramp_s() / dt)
        self.written = tuple(rate - rate / periods for rate in self.written)
        return self.written

    def _ramp_s(self) -> float:
        """Return how long a ramp from what was last written takes [s]."""
        longest: float = max(map(truediv, map(abs, self.written), self._changes))
        return longest

    def _bounded(self, wanted: Sequence[float], dt: float) -> tuple[float, ...] | None:
        """Return `wanted`, less what is rounding; None, with the fault latched, where it is not bounded."""
        if dt != self._dt:
            self._dt, self._steps = dt, tuple([change * dt for change in self._changes])
        if within(wanted, self.written, self._mosts, self._steps):
            return tuple(wanted)
        out: list[float] = []
        for rate, was, most, change_max in zip(wanted, self.written, self._mosts, self._changes, strict=True):
            change = change_max * dt
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
