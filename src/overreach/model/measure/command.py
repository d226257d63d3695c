"""What `overreach workspace` does."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
from tqdm import tqdm

from overreach.errors import SetupError, WorkspaceError
from overreach.files import write_text
from overreach.model.catalogue import description_of, measured, parted, parts_for, parts_in
from overreach.model.measure.figure import draw
from overreach.model.measure.homes import find_homes, with_home
from overreach.model.measure.text import drawing, table, with_table
from overreach.model.mujoco.robot import Parts

SHOWN = 5
FIGURES = (".svg", ".png", ".pdf")
"""Kinds of files that are drawn."""


def run_workspace(robot: str, mode: str, find_home: bool, out: Path | None, figure: Path | None) -> None:
    """Measure, draw, print and, where it is asked for, write; raises SetupError with nothing written."""
    if figure is not None and figure.suffix.lower() not in FIGURES:
        raise SetupError(f"--figure draws {', '.join(FIGURES)}, got {str(figure)!r}")
    if find_home and out is not None:
        raise SetupError("--find-home shows homes: put the one that you choose into the description, then use --out")
    parts = parts_for(robot, mode)
    for warning in parts.warnings:
        print(f"warning: {warning}")
    if find_home:
        parts = _with_best_home(parts, description_of(parted(robot)[0])[1])
    with tqdm(desc="cells tried", unit="", dynamic_ncols=True) as bar:
        result = measured(parts, progress=lambda more: _count(bar, more))
    description, found = parts.description, result.measured
    mode = description.mode
    print(f"{description.name}, {mode}: {result.does}\n")
    print(drawing(result))
    print()
    for warning in result.warnings:
        print(f"warning: {warning}")
    print(f"full deflection by the rule: v = {result.fastest:.3f} m/s\n")
    if find_home:
        print(f"home = {list(parts.description.home)}\n")
    where = f"hands.{description.driven}.workspace" if description.hands else "workspace"
    print(table(found, mode, where), end="")
    if out is not None:
        before = out.read_text("utf-8") if out.exists() else ""
        write_text(out, with_table(before, found, mode, where))
    if figure is not None:
        draw(result, parts.mount, description.base.footprint, f"{description.name}, {mode}: {result.does}", figure)


def _count(bar: Any, more: int) -> None:
    bar.update(more)


def _with_best_home(parts: Parts, folder: Path) -> Parts:
    with tqdm(desc="branches measured", unit="", dynamic_ncols=True) as bar:

        def progress(k: int, many: int) -> None:
            bar.total = many
            bar.update(k + 1 - bar.n)

        homes = find_homes(parts, lambda q: with_home(parts, q), progress)
    if not homes:
        raise WorkspaceError(
            "no home was found about which there is a sector: is the arm's shoulder where it should be?"
        )
    for home in homes[:SHOWN]:
        print(f"home = {list(home.q)}   # {home.volume:.4f} m^3, coarsely")
    print()
    return parts_in(msgspec.structs.replace(parts.description, home=homes[0].q), folder, parts.description.mode)
