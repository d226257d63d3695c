"""The file that the command of a scenario may come from."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

from overreach.errors import ScenarioError
from overreach.run.stamps import Segment
from overreach.run.text import read_text

FASTEST = 1e3
"""Greatest command [m/s, rad/s]: anything above this can only be a mistyped number."""


def read_commands(path: Path, name: str) -> tuple[Segment, ...]:
    """Read t,v_c,w_c rows; a header line with those names is required. Times as they stand there, increasing."""
    try:
        rows = list(csv.reader(io.StringIO(read_text(path), newline="")))
    except FileNotFoundError:
        raise ScenarioError(f"scenario {name!r}: no command file {str(path)!r}") from None
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ScenarioError(f"scenario {name!r}: cannot read command file {str(path)!r}: {error}") from None
    if not rows or [cell.strip() for cell in rows[0]] != ["t", "v_c", "w_c"]:
        found = ",".join(rows[0])[:60] if rows else "an empty file"
        hint = ": separate the columns by commas" if ";" in found or "\t" in found else ""
        raise ScenarioError(f"scenario {name!r}: {path.name} must begin with the header t,v_c,w_c, got {found!r}{hint}")
    segments: list[Segment] = []
    before = 0
    for number, row in enumerate(rows[1:], start=2):
        if not any(cell.strip() for cell in row):
            continue
        try:
            t, v_c, w_c = (float(cell) for cell in row)
        except ValueError:
            t = v_c = w_c = math.nan
        if not (math.isfinite(t) and abs(v_c) <= FASTEST and abs(w_c) <= FASTEST):
            raise ScenarioError(
                f"scenario {name!r}: {path.name} line {number}: three numbers are needed, "
                f"v_c and w_c within +-{FASTEST:g}, got {row}"
            )
        if segments and t <= segments[-1].t:
            raise ScenarioError(
                f"scenario {name!r}: {path.name} line {number}: its time {row[0].strip()} is not after "
                f"{segments[-1].t:.15g} of line {before}: the times must increase from row to row"
            )
        segments.append(Segment(t, v_c, w_c))
        before = number
    return tuple(segments)
