"""A machine that is busy with other things: writes stay a period apart, and what is late by less than two is no dip."""

from __future__ import annotations

import math
import time
from bisect import bisect
from itertools import pairwise
from pathlib import Path

import pytest

from tests.logged import Log
from tests.processes import Driver, hogs, robot, until
from tests.reached import Reached

pytestmark = pytest.mark.timed

PERIOD_S = 0.005
EARLY_S = 0.0002
"""A write comes so much before its usual time in the period at most."""


def test_two_busy_cores(tmp_path: Path, reached: Reached) -> None:
    """Driven beside two hogs: the host ramps only past two periods without a write, and no period has two writes."""
    log = Log(tmp_path)
    seconds = reached.times(600)
    with hogs(2), robot("logged", env=log.env) as (_, _, observer):
        driver = Driver(observer.link)
        driver.arm()
        end = time.monotonic() + seconds
        k = 0
        while time.monotonic() < end:
            # Round and round, so that the log has both directions.
            driver.drive(0.5, 0.4 if k % 2 else -0.4)
            k += 1
        overruns = observer.now.overruns
        driver.send(held=False)
        until(lambda: observer.speed() == 0.0, what="rest")
    entries = log.entries()
    own = [entry for entry in entries if entry.due == entry.now + PERIOD_S]  # as the host says of what it writes itself
    loops = [entry for entry in entries if entry.due != entry.now + PERIOD_S]
    assert len(loops) > 0.8 * seconds / PERIOD_S
    # The loop keeps its beat, and a write is good until two periods after it was made: from that, its period.
    made = [entry.due - 2.0 * PERIOD_S for entry in loops]
    usual = sorted((at - made[0]) % PERIOD_S for at in made)[len(made) // 2]
    begin = made[0] + usual - EARLY_S
    slots = [math.floor((at - begin) / PERIOD_S) for at in made]
    twice = len(slots) - len(set(slots))
    times = [entry.at for entry in loops]
    sooner = sum(entry.at < loops[bisect(times, entry.at) - 1].due for entry in own)
    longest = max(after - before for before, after in pairwise(times))
    reached.say(
        "loop overrun, CPU hog",
        f"{seconds} s beside two hogs, {len(loops):,} writes: {twice} periods with two, {overruns} overruns, "
        f"{len(own)} writes of the host, {sooner} of them within 2 periods; {longest * 1e3:.1f} ms apart at most",
    )
    assert (twice, sooner) == (0, 0)
