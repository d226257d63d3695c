"""Tables of runs, as CSV."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from overreach.files import write_text
from overreach.model.model import Model
from overreach.run.row import Row
from overreach.run.spatial_row import SpatialRow, columns, header


def write_csv(path: Path, rows: Sequence[Row]) -> None:
    """Write `rows` under a header of the field names, a column per joint; numbers round-trip exactly."""
    joints = [f"theta_{k + 1}" for k in range(len(rows[0].theta))]
    write_table(path, [*Row._fields[:-1], *joints], [(*row[:-1], *row.theta) for row in rows])


def write_spatial_csv(path: Path, rows: Sequence[SpatialRow], model: Model) -> None:
    """Write the rows of a robot in space, its joints by their names; numbers round-trip exactly."""
    write_table(path, header(model), [columns(row) for row in rows])


def write_table(path: Path, header: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    """Write any table of numbers and names under `header`; numbers round-trip exactly."""
    lines = [",".join(value if isinstance(value, str) else repr(value) for value in row) + "\n" for row in rows]
    write_text(path, ",".join(header) + "\n" + "".join(lines))
