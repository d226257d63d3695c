"""The lateness of the 200 Hz loop, with a page open, alone and beside two CPU hogs."""

from __future__ import annotations

import os
from collections.abc import Iterator

from benchmarks.measure import Promise, promise
from overreach.link.endpoint import free_port
from tests.browser.chromium import chromium
from tests.processes import Observer, half, hogs, robot

SECONDS = 20


def seconds_of(observer: Observer, page: object) -> list[tuple[float, float, float]]:
    """Return (p50, p99, max) [us] of each of the next SECONDS seconds."""
    page.wait_for_timeout(2_000)  # type: ignore[attr-defined]
    observer.states.clear()
    page.wait_for_timeout(SECONDS * 1_000)  # type: ignore[attr-defined]
    told = [(s.late_p50, s.late_p99, s.late_max) for s in list(observer.states)]
    return [one for one, before in zip(told[1:], told, strict=False) if one != before]


def run() -> Iterator[Promise]:
    """Measure with a page that drives."""
    fifo = "SCHED_FIFO" if hasattr(os, "SCHED_FIFO") and os.geteuid() == 0 else "no SCHED_FIFO"
    with robot() as (endpoint, _, observer), chromium() as browser:
        with half("cockpit", "--connect", endpoint, "--no-browser", "--port", str(free_port())) as cockpit:
            page = browser.new_page()
            page.goto(cockpit.url())
            page.wait_for_function("window.overreach?.page.state && overreach.link.ready")
            page.click("#arm")
            page.keyboard.down("ArrowUp")
            alone = seconds_of(observer, page)
            with hogs(2):
                beside = seconds_of(observer, page)
    for name, told, most in (("page open", alone, 0.5), ("page open, two CPU hogs", beside, 1.0)):
        yield promise(f"loop lateness p50, {name}", [one[0] / 1000 for one in told], "ms", note=fifo)
        yield promise(f"loop lateness p99, {name}", [one[1] / 1000 for one in told], "ms", most, note=fifo)
        yield promise(f"loop lateness max in a second, {name}", [one[2] / 1000 for one in told], "ms", note=fifo)
