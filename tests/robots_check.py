"""`python -m tests.robots_check STREAMS FILE`: every robot that we know, in and across its workspace, with seeds.

What they came to goes into FILE, with commit and seeds, and from there into docs/robots.md.
"""

from __future__ import annotations

import json
import os
import platform
import sys
from pathlib import Path
from typing import Any

import msgspec

from overreach.check.check import Found, check
from overreach.files import write_text
from overreach.model.described import DescribedRobot
from overreach.model.workspace import Workspace
from overreach.plugs import load_model
from tests.reached import commit

ROOT = Path(__file__).parents[1]
FILE, PAGE = ROOT / "build" / "robots.json", ROOT / "docs" / "robots.md"
BEGIN, END = "<!-- robots-check: begin -->", "<!-- robots-check: end -->"
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


def table(report: dict[str, Any]) -> str:
    """Return the report as the page has it: of each robot and mode, the worst of its seeds."""
    rows = [
        "| robot, mode | steps that are OK | streams of which all are | velocity error, rms / max [m/s] "
        "| attitude [rad] | beyond l, ψ, z [mm, rad, mm] | base drives | stick steps OK |",
        "|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    found = report["found"]
    for robot, mode in dict.fromkeys((one["robot"], one["mode"]) for one in found):
        own = [one for one in found if (one["robot"], one["mode"]) == (robot, mode)]
        smooth, steps = ([one for one in own if one["kind"] == kind] for kind in ("smooth", "steps"))

        def most(key: str, of: list[dict[str, Any]] = smooth) -> float:
            return float(max(one[key] for one in of))

        rows.append(
            f"| {robot}, {mode} | {min(one['ok_share'] for one in smooth):.6f} "
            f"| {sum(one['streams_all_ok'] for one in smooth):,} of {sum(one['streams'] for one in smooth):,} "
            f"| {most('ee_error_rms'):.1e} / {most('ee_error_max'):.1e} | {most('orientation_error_max'):.1e} "
            f"| {1000.0 * most('out_l'):.2f}, {most('out_psi'):.4f}, {1000.0 * most('out_z'):.2f} "
            f"| {100.0 * min(one['base_share'] for one in smooth):.0f} % "
            f"| {min(one['ok_share'] for one in steps):.5f} |"
        )
    rows += ["", "The same smooth streams in workspaces that are guessed instead:", ""]
    rows += ["| robot | guess | steps that are OK | streams of which all are |", "|---|---|---:|---:|"]
    for one in report["guessed"]:
        near, far, wide, high = GUESSES[one["guess"]]
        rows.append(
            f"| {one['robot']} | l = {near:g} to {far:g} R, ψ = ±{wide:g} rad, z = home ± {high:g} R "
            f"| {one['ok_share']:.4f} | {one['streams_all_ok']} of {one['streams']} |"
        )
    everything = [*found, *report["guessed"]]
    rows += [
        "",
        f"Joint limits passed: {sum(one['joint_limit_violations'] for one in found)}; contacts with itself: "
        f"{sum(one['self_contacts'] for one in found)} ({sum(one['self_contacts'] for one in everything)} with the "
        f"guesses); sideways velocity of the base: {max(one['lateral_base_max'] for one in found):g} m/s; base path of "
        f"a reach inside: {max(one['reach_base_path'] for one in found):g} m.",
    ]
    return "\n".join(rows)


def parts(page: str) -> tuple[str, str, str]:
    """Return what stands before, between and after the marks of a page."""
    before, rest = page.split(BEGIN)
    shown, after = rest.split(END)
    return before, shown.strip("\n"), after


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
    few = max(1, streams // 5)
    for robot in ("tiago", "mobile7"):
        model = load_model(robot)
        assert isinstance(model, DescribedRobot)
        R, z = model.arm.manner.reach, model.arm.posture_at_home.z
        for name, (near, far, wide, high) in GUESSES.items():
            guess = Workspace(near * R, far * R, -wide, wide, z - high * R, z + high * R, edges=True)
            one = check(robot, few, SEEDS[0], guess=guess)
            guessed.append({"guess": name, "workspace": msgspec.to_builtins(guess), **msgspec.to_builtins(one)})
            print(f"{robot:<14} {name} guess: {said(one, few)}", flush=True)
    machine = f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}"
    report = {"commit": commit(), "machine": machine, "found": found, "guessed": guessed}
    write_text(path, json.dumps(report, indent=1) + "\n")
    if path.resolve() == FILE:
        before, _, after = parts(PAGE.read_text("utf-8"))
        write_text(PAGE, f"{before}{BEGIN}\n{table(report)}\n{END}{after}")


if __name__ == "__main__":
    main()
