"""The only module that reads time. Everything else is given `now` [s]."""

from __future__ import annotations

import time
from typing import Protocol, final

nanoseconds = time.perf_counter_ns
"""The machine's finest clock [ns], for measuring what a call costs."""


class Clock(Protocol):
    """A monotonic clock that can wait."""

    def now(self) -> float:
        """Return the time [s]; only differences mean anything."""
        ...

    def sleep_until(self, deadline: float) -> None:
        """Return at `deadline` [s] or, if it has passed, at once."""
        ...


@final
class MonotonicClock:
    """The machine's monotonic clock: not moved by changes of the date.

    spin_s: the last part of a wait [s], which is spent polling the clock instead of sleeping. A processor that
    sleeps may take long to wake (in a virtual machine a millisecond or more); one that polls does not.
    """

    def __init__(self, spin_s: float = 0.0) -> None:
        self._spin_s = spin_s

    def now(self) -> float:
        """Return seconds since an arbitrary start."""
        return time.monotonic()

    def sleep_until(self, deadline: float) -> None:
        """Return at `deadline`."""
        wait = deadline - time.monotonic() - self._spin_s
        if wait > 0.0:
            time.sleep(wait)
        while time.monotonic() < deadline:
            pass


@final
class SteppedClock:
    """A clock that moves only when told: simulations and tests. `t` is the time [s]."""

    def __init__(self, t: float = 0.0) -> None:
        self.t = t

    def now(self) -> float:
        """Return `t`."""
        return self.t

    def sleep_until(self, deadline: float) -> None:
        """Move to `deadline` without waiting."""
        self.t = max(self.t, deadline)
