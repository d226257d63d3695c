"""How long a person waits."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator

from benchmarks.measure import Promise, promise
from overreach.link.endpoint import free_port
from tests.browser.chromium import chromium
from tests.processes import half


def run() -> Iterator[Promise]:
    """Measure `overreach --help`, and from `overreach drive` to a page that shows the robot's state."""
    took = []
    for _ in range(11):
        start = time.perf_counter()
        subprocess.run([sys.executable, "-m", "overreach", "--help"], stdout=subprocess.DEVNULL, check=True)
        took.append(time.perf_counter() - start)
    yield promise("overreach --help", took, "s", 0.3)
    printed, usable = [], []
    with chromium() as browser:
        for _ in range(5):
            start = time.perf_counter()
            with half("drive", "--no-browser", "--port", str(free_port())) as drive:
                url = drive.url()
                printed.append(time.perf_counter() - start)
                page = browser.new_page()
                page.goto(url)
                page.wait_for_function("window.overreach?.page.state && overreach.link.ready")
                usable.append(time.perf_counter() - start)
                page.close()
    yield promise("overreach drive: address printed", printed, "s")
    yield promise("overreach drive: page usable (browser already open)", usable, "s", 3.0)
