"""`python -m tests.robots_check STREAMS FILE [ROBOT ...]`: every robot that we know, in and across its workspace.

With three seeds. What they came to goes into FILE, with commit and seeds, and from there into docs/robots.md. Where
robots are named, these alone are checked, and take the place of what FILE says of them.
"""

from __future__ import annotations

import json
import os
import platform
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import msgspec

from overreach.check.check import Found, check
from overreach.files import write_text
from overreach.model.described import DescribedRobot
from overreach.model.workspace import Workspace
from overreach.plugs import load_model
from tests.reached import commit
from tests.ur5 import written

ROOT = Path(__file__).parents[1]
FILE, PAGE = ROOT / "build" / "robots.json", ROOT / "docs" / "robots.md"
BEGIN, END = "<!-- robots-check: begin -->", "<!-- robots-check: end -->"
SHOULDERS = {"ur5-ahead": 0.25, "ur5-over": 0.0, "ur5-behind": -0.3}
"""An arm of six joints, of the size of a UR5: where its shoulder is, ahead of the axle [m]."""
ROBOTS = (
    "tiago", "tiago#fixed", "mobile7", "mobile7#fixed", "mobile4", "omni7", "omni7#fixed", "omni5", *SHOULDERS,
    "stretch#fixed", "stretch#follow",
)  # fmt: skip
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
    differential = [one for one in found if not one["omni"]]
    rows += [
        "",
        f"Joint limits passed: {sum(one['joint_limit_violations'] for one in found)}; contacts with itself: "
        f"{sum(one['self_contacts'] for one in found)} ({sum(one['self_contacts'] for one in everything)} with the "
        f"guesses); sideways velocity of a differential base: {max(one['lateral_base_max'] for one in differential):g} "
        f"m/s; base path of a reach inside: {max(one['reach_base_path'] for one in found):.1g} m; mean scale at least "
        f"{min(one['mean_scale'] for one in found if one['kind'] == 'smooth'):.4f}.",
    ]
    return "\n".join(rows)


def parts(page: str) -> tuple[str, str, str]:
    """Return what stands before, between and after the marks of a page."""
    before, rest = page.split(BEGIN)
    shown, after = rest.split(END)
    return before, shown.strip("\n"), after


def checked(robots: Sequence[str], streams: int) -> list[dict[str, Any]]:
    """Check each robot with each seed, smooth streams and stick steps."""
    found, at = [], commit()
    with tempfile.TemporaryDirectory() as folder:
        for robot in robots:
            which = robot
            if robot in SHOULDERS:
                own = Path(folder) / robot
                own.mkdir()
                which = written(own, SHOULDERS[robot], name=robot)
            for seed in SEEDS:
                for kind in ("smooth", "steps"):
                    one = check(which, streams, seed, kind)
                    found.append({"commit": at, **msgspec.to_builtins(one)})
                    print(f"{robot:<14} seed {seed} {kind:<7} {said(one, streams)}", flush=True)
    return found


def guessed(streams: int) -> list[dict[str, Any]]:
    """Drive in workspaces that are guessed."""
    found, at = [], commit()
    for robot in ("tiago", "mobile7"):
        model = load_model(robot)
        assert isinstance(model, DescribedRobot)
        R, z = model.arm.manner.reach, model.arm.posture_at_home.z
        for name, (near, far, wide, high) in GUESSES.items():
            guess = Workspace(near * R, far * R, -wide, wide, z - high * R, z + high * R, edges=True)
            one = check(robot, streams, SEEDS[0], guess=guess)
            own = {"commit": at, "guess": name, "workspace": msgspec.to_builtins(guess)}
            found.append({**own, **msgspec.to_builtins(one)})
            print(f"{robot:<14} {name} guess: {said(one, streams)}", flush=True)
    return found


def order(one: dict[str, Any]) -> int:
    """Return where a robot in a mode stands in the list."""
    in_mode = f"{one['robot']}#{one['mode']}"
    return ROBOTS.index(in_mode if in_mode in ROBOTS else one["robot"])


def main() -> None:
    """Check, write what the robots came to, and the page from it."""
    streams, path, robots = int(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:]
    if "MENAGERIE_ROOT" not in os.environ:
        print("MENAGERIE_ROOT is not set: tiago is downloaded, if it can be", file=sys.stderr)
    if robots:
        report = json.loads(path.read_text("utf-8"))
        kept = [one for one in report["found"] if ROBOTS[order(one)] not in robots]
        report["found"] = sorted([*kept, *checked(robots, streams)], key=order)
    else:
        machine = f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}"
        report = {"machine": machine, "found": checked(ROBOTS, streams), "guessed": guessed(max(1, streams // 5))}
    write_text(path, json.dumps(report, indent=1) + "\n")
    if path.resolve() == FILE:
        before, _, after = parts(PAGE.read_text("utf-8"))
        write_text(PAGE, f"{before}{BEGIN}\n{table(report)}\n{END}{after}")


if __name__ == "__main__":
    main()
