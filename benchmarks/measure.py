"""How things are measured here: in turns, so that a slow minute of the machine hits all alike."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass


@dataclass(frozen=True)
class Promise:
    """A number with its spread (quartiles), and the most it may be."""

    name: str
    value: float
    low: float
    high: float
    unit: str
    most: float | None = None
    note: str = ""

    @property
    def kept(self) -> bool | None:
        """Whether the value is within what was promised; None where nothing was."""
        return None if self.most is None else self.value <= self.most

    def line(self) -> str:
        """One line of the report."""
        mark = {True: "ok  ", False: "MISS", None: "    "}[self.kept]
        limit = f"<= {self.most:g}" if self.most is not None else ""
        spread = f"[{self.low:.3g} to {self.high:.3g}]" if self.low != self.high else ""
        return f"{mark} {self.name:<52}{self.value:>9.3g} {self.unit:<6}{spread:<20}{limit:<10}{self.note}".rstrip()

    def as_dict(self) -> dict[str, object]:
        """For JSON."""
        return {**asdict(self), "kept": self.kept}


def promise(name: str, values: Sequence[float], unit: str, most: float | None = None, note: str = "") -> Promise:
    """Return the median of `values` with its quartiles as a promise."""
    if len(values) < 4:
        middle = statistics.median(values)
        return Promise(name, middle, min(values), max(values), unit, most, note)
    low, middle, high = statistics.quantiles(values, n=4)
    return Promise(name, middle, low, high, unit, most, note)


def percentile(values: Sequence[float], part: float) -> float:
    """Return the value below which `part` (0 to 1) of the values lie."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(part * len(ordered)))]


def in_turns(
    candidates: dict[str, Callable[[], object]], rounds: int = 60, calls: int = 2_000
) -> dict[str, list[float]]:
    """Return, for each candidate, the time of one call [us] in each round, less that of an empty call."""
    names = ["", *candidates]
    every = {"": lambda: None, **candidates}
    took: dict[str, list[float]] = {name: [] for name in names}
    for _ in range(rounds):
        for name in names:
            work = every[name]
            start = time.perf_counter()
            for _ in range(calls):
                work()
            took[name].append((time.perf_counter() - start) / calls * 1e6)
    empty = statistics.median(took.pop(""))
    return {name: [value - empty for value in values] for name, values in took.items()}
