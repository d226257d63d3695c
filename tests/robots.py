"""`python -m tests.robots STREAMS FILE`: every robot that we know, in and across its workspace, with seeds."""

from __future__ import annotations

import json
import os
import platform
import sys
from pathlib import Path

import msgspec

from overreach.check.check import check
from overreach.files import write_text
from tests.reached import commit

ROBOTS = ("tiago", "tiago#fixed", "mobile7", "mobile7#fixed", "mobile4")
SEEDS = (1, 2, 3)


def main() -> None:
    """Check each robot with each seed, smooth streams and stick steps, and write what they came to."""
    streams, path = int(sys.argv[1]), Path(sys.argv[2])
    if "MENAGERIE_ROOT" not in os.environ:
        print("MENAGERIE_ROOT is not set: tiago is downloaded, if it can be", file=sys.stderr)
    found = []
    for robot in ROBOTS:
        for seed in SEEDS:
            for kind in ("smooth", "steps"):
                one = check(robot, streams, seed, kind)
                found.append(msgspec.to_builtins(one))
                print(
                    f"{robot:<14} seed {seed} {kind:<7} ok {one.ok_share:.6f}, {one.streams_all_ok} of {streams}, "
                    f"error {one.ee_error_rms:.1e} rms {one.ee_error_max:.1e} max, attitude "
                    f"{one.orientation_error_max:.1e}, out {one.out_l:.1e} {one.out_psi:.1e} {one.out_z:.1e}, gap "
                    f"{one.min_joint_gap:.3f}, contacts {one.self_contacts}, base {one.base_share:.2f}",
                    flush=True,
                )
    machine = f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}"
    write_text(path, json.dumps({"commit": commit(), "machine": machine, "found": found}, indent=1) + "\n")


if __name__ == "__main__":
    main()
