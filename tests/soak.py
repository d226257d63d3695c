"""`python -m tests.soak TIME FILE`: everything runs and is driven, with stops and settings; memory is looked at.

Real halves, a real page that drives, and a second operator who interferes. After the first minute no process may grow
by GROWTH_MIB; the file has every sample, and how fast each grows.
"""

from __future__ import annotations

import json
import random
import statistics
import subprocess
import sys
import time
from pathlib import Path

import msgspec
import psutil

from overreach.link.endpoint import free_port
from overreach.link.messages import ConfigureRequest
from overreach.requests import ResetRequest, RestartRequest, StopRequest
from tests.browser.chromium import chromium
from tests.processes import half, robot, until

WARM_S = 60.0
GROWTH_MIB = 2.0
LOOK_S = 1.0
KEYS = ("ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight")


def uss(process: psutil.Process) -> float:
    """Return what a process holds and no other does [MiB]."""
    return float(process.memory_full_info().uss) / 2**20


def duration(text: str) -> float:
    """Return 1h, 5m, 90s or 90 in seconds."""
    unit = {"h": 3600.0, "m": 60.0, "s": 1.0}.get(text[-1:], 0.0)
    return float(text[:-1]) * unit if unit else float(text)


def slope(samples: list[tuple[float, float]]) -> float:
    """Return the growth [MiB/h] of samples of (time [s], size [MiB]), by least squares."""
    line = statistics.linear_regression([t for t, _ in samples], [size for _, size in samples])
    return float(line.slope * 3600.0)


def main() -> None:
    """Soak, write, and end with 1 if something grew."""
    seconds, target = duration(sys.argv[1]), Path(sys.argv[2])
    chance = random.Random(1)
    samples: dict[str, list[tuple[float, float]]] = {}
    acts = 0
    with robot() as (endpoint, side, observer), chromium() as browser:
        with half("cockpit", "--connect", endpoint, "--no-browser", "--port", str(free_port())) as cockpit:
            page = browser.new_page()
            page.goto(cockpit.url())
            page.wait_for_function("window.overreach?.page.state && overreach.link.ready")
            host = next(child for child in side.children if "overreach.host" in child.cmdline())
            watched = {"robot side": psutil.Process(side.process.pid), "robot's host": host,
                       "cockpit": psutil.Process(cockpit.process.pid)}  # fmt: skip
            samples = {name: [] for name in watched}
            begun = looked = time.monotonic()
            while (now := time.monotonic() - begun) < seconds:
                acts += 1
                act = chance.random()
                if act < 0.1:
                    observer.link.request(StopRequest())
                    page.wait_for_timeout(100)
                    observer.link.request(ResetRequest())
                elif act < 0.15:
                    observer.link.request(RestartRequest())
                elif act < 0.25:
                    scale = chance.choice((0.5, 0.8, 1.0))
                    wanted = msgspec.structs.replace(observer.welcome.settings, speed_scale=scale)
                    observer.link.request(ConfigureRequest(wanted))
                page.evaluate("document.getElementById('arm').disabled || document.getElementById('arm').click()")
                key = chance.choice(KEYS)
                page.keyboard.down(key)
                page.wait_for_timeout(chance.uniform(50, 800))
                page.keyboard.up(key)
                observer.states.clear()
                if time.monotonic() - looked >= LOOK_S:
                    looked = time.monotonic()
                    for name, process in watched.items():
                        samples[name].append((round(now, 2), round(uss(process), 3)))
            until(lambda: len(observer.states) > 0, what="a last state")
            overruns = observer.now.overruns
    commit = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True, check=True).stdout.strip()
    after = {name: [one for one in each if one[0] >= min(WARM_S, seconds / 2)] for name, each in samples.items()}
    growth = {name: round(max(size for _, size in each) - each[0][1], 3) for name, each in after.items()}
    found = {
        "commit": commit, "seconds": seconds, "acts": acts, "overruns": overruns,
        "growth_mib": growth,
        "slope_mib_per_hour": {name: round(slope(each), 3) for name, each in after.items()},
        "samples": samples,
    }  # fmt: skip
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(json.dumps(found) + "\n")
    print(json.dumps({name: value for name, value in found.items() if name != "samples"}, indent=1))
    grown = {name: size for name, size in growth.items() if size >= GROWTH_MIB}
    if grown:
        print(f"grew by {GROWTH_MIB:g} MiB or more after the first minute: {grown}", file=sys.stderr)
        raise SystemExit(1)


main()
