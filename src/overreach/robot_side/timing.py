"""How late the loop is: counters that cost the loop one increment a tick."""

from __future__ import annotations

from math import log2
from typing import final

PER_OCTAVE = 16
"""Bins for each doubling: percentiles are known to 4 %."""
BINS = 24 * PER_OCTAVE


@final
class Lateness:
    """A histogram of latenesses [s] on a logarithmic scale from 1 us to 16 s."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget everything."""
        self._bins = [0] * BINS
        self.count = 0
        self.most = 0.0

    def add(self, late: float) -> None:
        """Count one tick that began `late` [s] after its time."""
        us = late * 1e6
        self._bins[min(BINS - 1, int(log2(us) * PER_OCTAVE)) if us > 1.0 else 0] += 1
        self.count += 1
        self.most = max(self.most, late)

    def percentile(self, part: float) -> float:
        """Return the lateness [us] below which `part` (0 to 1) of the ticks lie; 0 without ticks."""
        left = part * self.count
        for k, many in enumerate(self._bins):
            left -= many
            if left <= 0.0:
                return float(2.0 ** ((k + 1) / PER_OCTAVE)) if self.count else 0.0
        return self.most * 1e6
