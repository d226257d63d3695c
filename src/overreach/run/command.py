"""The command of a scenario: segments, and the file they may come from."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from overreach.errors import ScenarioError
from overreach.types import Record

FASTEST = 1e3
"""Greatest command [m/s, rad/s]: anything above this can only be a mistyped number."""


class Segment(Record, frozen=True):
    """From t [s] on, until the next segment, the command is (v_c, w_c)."""

    t: float
    v_c: float
    w_c: float


def read_commands(path: Path, name: str) -> tuple[Segment, ...]:
    """Read t,v_c,w_c rows; a header line with those names is required."""
    try:
        with path.open(newline="", encoding="utf-8") as stream:
            rows = list(csv.reader(stream))
    except FileNotFoundError:
        raise ScenarioError(f"scenario {name!r}: no command file {str(path)!r}") from None
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ScenarioError(f"scenario {name!r}: cannot read command file {str(path)!r}: {error}") from None
    if not rows or [cell.strip() for cell in rows[0]] != ["t", "v_c", "w_c"]:
        raise ScenarioError(f"scenario {name!r}: {path.name} must begin with the header t,v_c,w_c")
    segments = []
    for number, row in enumerate(rows[1:], start=2):
        if not row:
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
        segments.append(Segment(t, v_c, w_c))
    return tuple(segments)
