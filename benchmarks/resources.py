"""What driving costs: processor time and memory of both halves."""

from __future__ import annotations

from collections.abc import Iterator

import psutil

from benchmarks.measure import Promise, promise
from overreach.link.endpoint import free_port
from tests.browser.chromium import chromium
from tests.processes import half

SECONDS = 4
ROUNDS = 5


def run() -> Iterator[Promise]:
    """Measure while a page drives."""
    with half("drive", "--no-browser", "--port", str(free_port())) as drive, chromium() as browser:
        page = browser.new_page(viewport={"width": 1360, "height": 850})
        page.goto(drive.url())
        page.wait_for_function("window.overreach?.page.state && overreach.link.ready")
        page.click("#arm")
        page.keyboard.down("ArrowUp")
        page.wait_for_timeout(1_000)
        cockpit, robot = psutil.Process(drive.process.pid), drive.children[0]
        server, side, memory = [], [], []
        for _ in range(ROUNDS):
            before = [sum(process.cpu_times()[:2]) for process in (cockpit, robot)]
            page.wait_for_timeout(SECONDS * 1_000)
            after = [sum(process.cpu_times()[:2]) for process in (cockpit, robot)]
            server.append((after[0] - before[0]) / SECONDS * 100)
            side.append((after[1] - before[1]) / SECONDS * 100)
            memory.append(sum(process.memory_info().rss for process in (cockpit, robot)) / 1e6)
    yield promise("server (operator side) while driving", server, "%core", 15.0)
    yield promise("robot side while driving", side, "%core")
    yield promise("memory of both processes", memory, "MB", 250.0)
