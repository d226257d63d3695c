"""What `overreach check` does."""

from __future__ import annotations

import json as json_
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
from tqdm import tqdm

from overreach.check.check import Found, check
from overreach.check.found import facts
from overreach.check.streams import KINDS
from overreach.errors import SetupError
from overreach.files import write_text
from overreach.plugs import in_mode

LINES: tuple[tuple[str, str, str], ...] = (
    ("ok_share", "steps that are OK", "of 1"),
    ("streams_all_ok", "streams of which all are", ""),
    ("ee_error_rms", "EE velocity error, rms", "m/s"),
    ("ee_error_max", "EE velocity error, max", "m/s"),
    ("orientation_error_max", "attitude error, max", "rad"),
    ("mean_scale", "scale, mean", "of 1"),
    ("base_share", "time in which the base drives", "of 1"),
    ("speed_rms", "commanded speed, rms", "m/s"),
    ("crossings", "limits crossed, a stream", ""),
    ("joint_limit_violations", "joint limits passed", ""),
    ("min_joint_gap", "least distance to one", "rad, m"),
    ("self_contacts", "contacts with itself", ""),
    ("lateral_base_max", "sideways base velocity", "m/s"),
    ("out_l", "outside, in l", "m"),
    ("out_psi", "outside, in psi", "rad"),
    ("out_z", "outside, in z", "m"),
    ("reach_base_path", "base path of a reach inside", "m"),
)
"""Field, label, unit: in the order in which they are shown."""


def run_check(robot: str, mode: str, streams: int, seed: int, out: Path | None, jobs: int) -> None:
    """Print what was found and what the streams came to, and write it where that is asked for. Raises SetupError."""
    for value, least, option in ((streams, 1, "--streams"), (jobs, 0, "--jobs"), (seed, 0, "--seed")):
        if value < least:
            raise SetupError(f"{option} must be at least {least}, got {value}")
    which = in_mode(robot, mode)
    said = facts(which)
    print("\n".join(said))
    found = []
    for kind in KINDS:
        with tqdm(total=streams, desc=f"{kind} streams", unit="", dynamic_ncols=True) as bar:
            found.append(check(which, streams, seed, kind, jobs, partial(_show, bar)))
    print(table(found))
    if out is not None:
        write_text(out, json_.dumps({one.kind: msgspec.to_builtins(one) for one in found}, indent=2) + "\n")


def _show(bar: Any, done: int) -> None:
    bar.update(done - bar.n)


def table(found: list[Found]) -> str:
    """Return the numbers side by side."""
    first = found[0]
    lines = [
        f"{first.robot}, {first.mode}: {first.streams} streams of 20 s each, seed {first.seed}, "
        f"v = {first.v:g} m/s, w = {first.w:g} rad/s, v_z = {first.v_z:g} m/s",
        f"  {'':<32}" + "".join(f"{one.kind:>12}" for one in found),
    ]
    for key, label, unit in LINES:
        values = "".join(f"{_shown(getattr(one, key)):>12}" for one in found)
        lines.append(f"  {label:<32}{values}  {unit}".rstrip())
    return "\n".join(lines)


def _shown(value: float) -> str:
    return str(value) if isinstance(value, int) else "0" if abs(value) < 1e-12 else f"{value:.5g}"
