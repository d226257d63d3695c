"""The faults of SAFETY.md, and what the tests reach: `make faults` runs them in full and writes it down.

A test that takes the fixture `reached` asks it how often to try, and says what it found. `python -m tests.reached`
gathers what a full run said in build/faults.json, with commit and seed, and writes it from there into SAFETY.md.
"""

from __future__ import annotations

import json
import math
import platform
import re
import subprocess
import sys
from pathlib import Path
from typing import Any, final

ROOT = Path(__file__).parents[1]
FILE = ROOT / "build" / "faults.json"
PARTS = ROOT / "build" / "reached"
PAGE = ROOT / "SAFETY.md"
BEGIN, END = "<!-- reached: begin -->", "<!-- reached: end -->"
PART = 20
"""An ordinary run tries one in this many times."""
NOT_YET = "not yet"
"""What a promise is that this version does not make."""

ROWS: dict[str, tuple[str, str]] = {
    "link lost at any phase": ("ramp, disarm", "v = 0 within 200 ms + tick + v/a, 1000 of 1000 phases"),
    "late, jitter 100 +- 50 ms": ("used if fresh", "no limit breach in 1e6 ticks, no false stop below 150 ms"),
    "duplicate, reordered": ("refuse by sequence", "same output as the sorted unique stream"),
    "replay of an old session": ("refuse by session and sequence", "0 of 10,000 accepted"),
    "NaN, inf, wrong type, extra field": (
        "refuse", "0 non-finite outputs in 1e6; only documented errors in 1e6 fuzzed frames",
    ),
    "huge jump": ("bounded", "abs(dv) <= a dt always"),
    "wall-clock jump, sender clock +-1 h": ("none", "identical output"),
    "sender suspended, then backlog": ("newest only, disarm", "0 motion until re-arm"),
    "two operators": ("the second watches; takeover passes through disarm", "never two sources in a tick, 8 clients"),
    "slow or stalled page": ("at most 6 unacknowledged pictures", "loop lateness unchanged; <= 0.5 s stale"),
    "page closed, hidden, blurred, gamepad unplugged": ("ramp", "<= 200 ms even if the event is lost"),
    "feedback NaN, out of range, biased, frozen, not following": (
        "ramp from what was last written, FAULT", "limits kept for any stream; 0 false alarms in 1 h",
    ),
    "kill -9, SIGSTOP, SEGV, hang of the loop": (
        "the robot's host ramps by itself", "at rest within 2 periods + v/a + a tick, 50 of 50 each",
    ),
    "the robot's host dies or hangs": ("FAULT, and the page says so", "within 100 ms"),
    "INT, TERM, HUP, exception": ("ramp", "never a step"),
    "constant or growing delay of the path": (
        "age of the command on the robot's own clock",
        "at rest <= 0.45 s + bound after letting go; Stop <= 0.3 s on a path 20 % too narrow",
    ),
    "another user or process of the machine": ("none: there is no token", NOT_YET),
    "floods of requests, connections, frames": ("bounded", "<= 2 ms between writes beyond the period"),
    "kill -9 of cockpit": ("ramp / go on", "0 missed ticks"),
    "kill -9 of recorder": ("none: nothing is recorded", NOT_YET),
    "loop overrun, CPU hog": ("count, hold, ramp; never burst", "no two writes in a period"),
    "joint limit, singularity, out of reach": (
        "brake, damp; backing out always allowed", "overshoot <= 1e-3 rad; joint speed <= limit; sign changes < 2/s",
    ),
    "baseline's solver fails": ("ramp, for as long as it fails", "0 exceptions leave the loop"),
    "Stop pressed": (
        "latched; reset is deliberate and does not move",
        "no path STOPPED -> MOVING without reset, release, press; all sequences to length 8",
    ),
    "foreign Origin, foreign Host": ("403", "0 of 20 accepted"),
    "oversized frame": ("close 1009", "memory growth < 2 MiB"),
    "disk full while recording": ("none: nothing is recorded", NOT_YET),
    "killed or cut while recording": ("none: nothing is recorded", NOT_YET),
    "plug-in raises, hangs, returns nonsense": ("ramp / host", "0 escapes"),
    "two hosts: cut, restore, delay, narrow": ("ramp, disarm, re-arm", "no motion on return"),
}  # fmt: skip
"""Fault -> reaction, and the number that is promised."""


@final
class Reached:
    """How often a test tries, and what it reached. full: as often as is promised; else one in PART times."""

    def __init__(self, test: str, full: bool, seed: int) -> None:
        self.full, self.seed = full, seed
        self._test = re.sub(r"\W+", "_", test)
        self._said = 0

    def times(self, promised: int) -> int:
        """Return how often to try what is promised for `promised` times."""
        return promised if self.full else math.ceil(promised / PART)

    def say(self, fault: str, text: str) -> None:
        """Note what was reached for a fault of ROWS."""
        assert fault in ROWS, f"{fault!r} is no row of SAFETY.md"
        print(f"{fault}: {text}")
        if self.full:
            PARTS.mkdir(parents=True, exist_ok=True)
            self._said += 1
            said = {"fault": fault, "text": text, "seed": self.seed, "commit": commit()}
            (PARTS / f"{self._test}_{self._said}.json").write_text(json.dumps(said))


def commit() -> str:
    """Return the commit that is checked out."""
    git = ["git", "-C", str(ROOT), "rev-parse", "HEAD"]
    return subprocess.run(git, capture_output=True, text=True, check=True).stdout.strip()


def gathered() -> dict[str, Any]:
    """Return what a full run said, by fault, with where and when it was said."""
    said = [json.loads(path.read_text()) for path in sorted(PARTS.glob("*.json"))]
    return {
        "commits": sorted({one["commit"] for one in said}),
        "seeds": sorted({one["seed"] for one in said}),
        "machine": f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}",
        "reached": {fault: sorted(one["text"] for one in said if one["fault"] == fault) for fault in ROWS},
    }


def table(found: dict[str, Any]) -> str:
    """Return the table of SAFETY.md for the contents of FILE."""
    lines = [
        f"Reached by `make faults` at {', '.join(one[:10] for one in found['commits'])}, seed "
        f"{', '.join(map(str, found['seeds']))}, on {found['machine']}; in full in build/faults.json.",
        "",
        "| fault | reaction, and the number promised | reached |",
        "|---|---|---|",
    ]
    for fault, (reaction, promise) in ROWS.items():
        texts = found["reached"].get(fault, [])
        told = "<br>".join(texts) or ("not yet" if promise == NOT_YET else "not measured")
        asked = reaction if promise == NOT_YET else f"{reaction}: {promise}"
        lines.append(f"| {fault} | {asked} | {told} |")
    return "\n".join(lines)


def parts(page: str) -> tuple[str, str, str]:
    """Return SAFETY.md before the table, the table, and after it."""
    before, begun, rest = page.partition(BEGIN)
    inside, ended, after = rest.partition(END)
    assert begun, f"SAFETY.md lacks {BEGIN}"
    assert ended, f"SAFETY.md lacks {END}"
    return before, inside.strip(), after


def main() -> None:
    """Gather, and write."""
    found = gathered()
    FILE.write_text(json.dumps(found, indent=1) + "\n")
    before, _, after = parts(PAGE.read_text())
    PAGE.write_text(f"{before}{BEGIN}\n{table(found)}\n{END}{after}")
    missing = [fault for fault, (_, promise) in ROWS.items() if promise != NOT_YET and not found["reached"][fault]]
    if missing:
        print(f"nothing was reached for: {'; '.join(missing)}", file=sys.stderr)
        raise SystemExit(1)


if __name__ == "__main__":
    main()
