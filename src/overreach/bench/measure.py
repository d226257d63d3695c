"""How a call is timed: candidates in turns, so that a slow moment of the machine hits all alike.

In each round a candidate runs three times over the same arguments. Once to be warm. Once without a clock in between:
that gives the mean. Once with the clock read before and after every call: that gives min, p50, p99, p999 and max. A
clock that is read makes the processor finish what it had begun, so a stamped call shows its latency.
"""

from __future__ import annotations

import gc
import math
import statistics
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from overreach.clock import nanoseconds
from overreach.types import Record

Arguments = Sequence[tuple[Any, ...]]
QUANTILES = {"p50": 0.5, "p99": 0.99, "p999": 0.999}


class Spread(Record, frozen=True):
    """The median over the rounds, with its quartiles."""

    median: float
    low: float
    high: float


def spread(values: Sequence[float]) -> Spread:
    """Return the median of `values` with the quartiles; of a single value, that value."""
    if len(values) == 1:
        return Spread(values[0], values[0], values[0])
    low, middle, high = statistics.quantiles(values, n=4, method="inclusive")
    return Spread(middle, low, high)


def statistics_of(took: Sequence[float]) -> dict[str, float]:
    """Return stamped_mean, min, p50, p99, p999 and max of the times of single calls, in their unit."""
    ordered = sorted(took)
    n = len(ordered)
    return {
        "stamped_mean": sum(ordered) / n,
        "min": ordered[0],
        **{name: ordered[max(0, math.ceil(part * n) - 1)] for name, part in QUANTILES.items()},
        "max": ordered[-1],
    }


@dataclass
class Candidate:
    """Something to be timed: `call(*arguments)` for each of `arguments`, in every `every`-th round."""

    name: str
    call: Callable[..., Any]
    arguments: Arguments
    every: int = 1


@dataclass
class Timed:
    """What a candidate took [us]: per round, its statistics; `worst` is the longest single call of all."""

    rounds: dict[int, dict[str, float]]
    calls: int

    def of(self, statistic: str) -> Spread:
        """Return the median over the rounds of a statistic, with its quartiles."""
        return spread([values[statistic] for values in self.rounds.values()])

    @property
    def worst(self) -> float:
        """The longest single call of the whole run."""
        return max(values["max"] for values in self.rounds.values())

    def as_dict(self) -> dict[str, Any]:
        """For JSON: the medians by name, their quartiles under `spread`, `worst` and the number of calls."""
        names = next(iter(self.rounds.values()))
        found = {name: self.of(name) for name in names}
        return {
            **{name: value.median for name, value in found.items()},
            "worst": self.worst,
            "calls": self.calls,
            "spread": {name: [value.low, value.high] for name, value in found.items()},
        }


def timed(candidate: Candidate, overhead: float) -> list[float]:
    """Return the time of each call [us], less `overhead` (never below 1 ns)."""
    call, now = candidate.call, nanoseconds
    took = []
    for arguments in candidate.arguments:
        start = now()
        call(*arguments)
        end = now()
        took.append(end - start)
    return [max(0.001, value / 1000.0 - overhead) for value in took]


def mean(candidate: Candidate) -> float:
    """Return the time of the whole block by its number of calls [us]: no clock between the calls."""
    call = candidate.call
    for arguments in candidate.arguments:
        call(*arguments)
    start = nanoseconds()
    for arguments in candidate.arguments:
        call(*arguments)
    return (nanoseconds() - start) / len(candidate.arguments) / 1000.0


def clock_overhead(calls: int = 2_000) -> float:
    """Return what asking the clock twice takes at least [us]: part of every measured time, and never more than it."""
    now = nanoseconds
    took = []
    for _ in range(calls):
        start = now()
        took.append(now() - start)
    return min(took) / 1000.0


def in_turns(
    candidates: Sequence[Candidate], rounds: int, tell: Callable[[int], object] = lambda done: None
) -> dict[str, Timed]:
    """Return what each candidate took. A round calls every candidate on all its arguments, in turn.

    The order turns from round to round, the garbage collector stands still meanwhile. `tell` hears the rounds done.
    """
    found = {candidate.name: Timed({}, 0) for candidate in candidates}
    collecting = gc.isenabled()
    gc.collect()
    gc.disable()
    try:
        for number in range(rounds):
            overhead = clock_overhead()
            shift = number % len(candidates)
            for candidate in (*candidates[shift:], *candidates[:shift]):
                if number % candidate.every:
                    continue
                result = found[candidate.name]
                result.rounds[number] = {"mean": mean(candidate), **statistics_of(timed(candidate, overhead))}
                result.calls += len(candidate.arguments)
            tell(number + 1)
    finally:
        if collecting:
            gc.enable()
    return found


def ratio(slow: Timed, fast: Timed, statistic: str) -> Spread:
    """Return slow/fast of a statistic, round by round (both ran in the same round), as a spread."""
    common: Iterable[int] = slow.rounds.keys() & fast.rounds.keys()
    return spread([slow.rounds[k][statistic] / fast.rounds[k][statistic] for k in sorted(common)])
