"""What `overreach check --all` does: every property for every robot that ships, in each mode that was measured."""

from __future__ import annotations

import json as json_
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
from tqdm import tqdm

from overreach.check.command import run_check
from overreach.check.properties import Property, properties
from overreach.errors import SetupError
from overreach.files import write_text
from overreach.model.catalogue import described
from overreach.model.description import read_description
from overreach.plugs import in_mode, load_model


def all_of_them() -> list[str]:
    """Return each robot that is described, in each mode for which its workspace ships."""
    return [
        in_mode(name, mode) for name, text in described().items() for mode in read_description(text, name).workspace
    ]


def run_one_or_all(robot: str, every: bool, mode: str, streams: int, seed: int, out: Path | None, jobs: int) -> bool:
    """Check one robot, or every one of them; say whether all properties are kept. Raises SetupError."""
    if every and robot:
        raise SetupError(f"check takes a robot or --all, not both: got {robot!r} and --all")
    if every:
        return run_all(streams, seed, out, jobs)
    if not robot:
        raise SetupError("check needs a robot, or --all: `overreach robots` lists them")
    run_check(robot, mode, streams, seed, out, jobs)
    return True


def run_all(streams: int, seed: int, out: Path | None, jobs: int) -> bool:
    """Print each robot's properties, and write them where that is asked for; say whether all are kept.

    A robot whose model cannot be had is named. Raises SetupError where there is none left.
    """
    found: list[Property] = []
    missing: list[str] = []
    for which in all_of_them():
        try:
            load_model(which)
        except SetupError as error:
            missing.append(f"{which} was not checked: {error}")
            continue
        with tqdm(total=2 * streams, desc=which, unit="", dynamic_ncols=True) as bar:
            own = properties(which, streams, seed, jobs, partial(_show, bar))
        print(table(own), flush=True)
        found += own
    for line in missing:
        print(line)
    if not found:
        raise SetupError("no robot's model can be had: there is nothing to check")
    broken = [one for one in found if not one.kept]
    robots = len({(one.robot, one.mode) for one in found})
    print(f"{len(found) - len(broken)} of {len(found)} properties of {robots} robots and modes are kept")
    if out is not None:
        rows = [{**msgspec.to_builtins(one), "kept": one.kept} for one in found]
        write_text(out, json_.dumps({"streams": streams, "seed": seed, "properties": rows}, indent=2) + "\n")
    return not broken


def table(own: list[Property]) -> str:
    """Return the properties of a robot, a line each."""
    lines = [f"{own[0].robot}, {own[0].mode}"]
    for one in own:
        bound = f"{'>=' if one.least else '<='} {one.limit:g}"
        lines.append(f"  {'kept' if one.kept else 'NOT KEPT':<9}{one.name:<52}{one.value:>12.4g}  {bound}")
    return "\n".join(lines)


def _show(bar: Any, done: int) -> None:
    bar.update(done - bar.n)
