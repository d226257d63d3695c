"""`python -m tests.robots STREAMS FILE`: every robot that we know, in and across its workspace, with seeds."""

from __future__ import annotations

import json
import os
import platform
import sys
from pathlib import Path

import msgspec

from overreach.check.check import Found, check
from overreach.files import write_text
from overreach.model.described import DescribedRobot
from overreach.model.workspace import Workspace
from overreach.plugs import load_model
from tests.reached import commit

ROBOTS = ("tiago", "tiago#fixed", "mobile7", "mobile7#fixed", "mobile4")
SEEDS = (1, 2, 3)
GUESSES = {"cautious": (0.55, 0.9, 0.8, 0.2), "usual": (0.4, 0.95, 1.0, 0.35)}
"""Workspaces guessed from a data sheet: l from and to, in parts of R; psi [rad] either way; z about home, likewise."""


def said(one: Found, streams: int) -> str:
    """Return the numbers in a line."""
    return (
        f"ok {one.ok_share:.6f}, {one.streams_all_ok} of {streams}, error {one.ee_error_rms:.1e} rms "
        f"{one.ee_error_max:.1e} max, attitude {one.orientation_error_max:.1e}, out {one.out_l:.1e} {one.out_psi:.1e} "
        f"{one.out_z:.1e}, gap {one.min_joint_gap:.3f}, contacts {one.self_contacts}, base {one.base_share:.2f}"
    )


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
                print(f"{robot:<14} seed {seed} {kind:<7} {said(one, streams)}", flush=True)
    guessed = []
    for robot in ("tiago", "mobile7"):
        model = load_model(robot)
        assert isinstance(model, DescribedRobot)
        R, z = model.arm.manner.reach, model.arm.posture_at_home.z
        for name, (near, far, wide, high) in GUESSES.items():
            guess = Workspace(near * R, far * R, -wide, wide, z - high * R, z + high * R, edges=True)
            one = check(robot, max(1, streams // 5), SEEDS[0], guess=guess)
            guessed.append({"guess": name, "workspace": msgspec.to_builtins(guess), **msgspec.to_builtins(one)})
            print(f"{robot:<14} {name} guess: {said(one, streams // 5)}", flush=True)
    machine = f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}"
    write_text(
        path, json.dumps({"commit": commit(), "machine": machine, "found": found, "guessed": guessed}, indent=1) + "\n"
    )


if __name__ == "__main__":
    main()
