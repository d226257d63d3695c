"""What a robot's own process costs: the loop's end of it per tick, and the time between writes, with and without."""

from __future__ import annotations

import time
from collections.abc import Iterator
from statistics import median

from benchmarks.measure import Promise, promise
from overreach.clock import MonotonicClock
from overreach.host.hosted import Hosted
from overreach.types import BaseTwist
from tests.processes import Driver, robot

RATE = 200.0
TICKS = 2_000
ROUNDS = 5
SECONDS = 10


def cost() -> tuple[list[float], list[float]]:
    """Return what reading and writing took at each of TICKS ticks [us]."""
    clock = MonotonicClock(0.0004)
    hosted = Hosted("planar", 1.0 / RATE, clock)
    reads, writes = [], []
    try:
        due = clock.now()
        for k in range(TICKS):
            due += 1.0 / RATE
            clock.sleep_until(due)
            begun = time.perf_counter()
            hosted.read(due)
            read = time.perf_counter()
            hosted.write(BaseTwist(0.1 * (k % 2), 0.0, 0.0), (0.0, 0.1), None, due, due + 2.0 / RATE)
            reads.append((read - begun) * 1e6)
            writes.append((time.perf_counter() - read) * 1e6)
    finally:
        hosted.close()
    return reads, writes


def apart(*options: str) -> tuple[list[float], float]:
    """Drive for SECONDS; return the p99 of each second and the greatest time between writes beyond a period [us]."""
    with robot(*options) as (_, _, observer):
        driver = Driver(observer.link)
        driver.arm()
        driver.drive(2.0)
        observer.states.clear()
        driver.drive(SECONDS)
        told = [(s.apart_p99, s.apart_max) for s in list(observer.states)]
    each = [one for one, before in zip(told[1:], told, strict=False) if one != before]
    return [p99 for p99, _ in each], max(most for _, most in each)


def run() -> Iterator[Promise]:
    """Measure, hosted and not, in turn."""
    reads, writes = cost()
    both = [read + write for read, write in zip(reads, writes, strict=True)]
    yield promise("hosted robot, read and write a tick", both, "us", 50.0)
    found: dict[str, list[float]] = {"hosted": [], "not": []}
    for _ in range(ROUNDS):
        for name, options in (("hosted", ()), ("not", ("--no-hosted",))):
            p99s, _ = apart(*options)
            found[name].append(median(p99s))
    yield promise("write to write beyond a period, p99, hosted", found["hosted"], "us")
    yield promise("write to write beyond a period, p99, in the loop's process", found["not"], "us")
    ratios = [one / other for one, other in zip(found["hosted"], found["not"], strict=True)]
    yield promise("write to write, p99, hosted to not: (period + p99)", [
        (1e6 / RATE + one) / (1e6 / RATE + other)
        for one, other in zip(found["hosted"], found["not"], strict=True)
    ], "", 1.2)  # fmt: skip
    yield promise("the same of what is beyond the period", ratios, "", 1.2)
