"""What happened in a run, in numbers. Each with its formula and unit."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import hypot, sqrt
from typing import TYPE_CHECKING

from overreach.types import Record, Verdict

if TYPE_CHECKING:
    from overreach.experiments.run import Row
    from overreach.experiments.scenario import Scenario


class Summary(Record, frozen=True):
    """The table that `overreach simulate` prints; e is the EE's true velocity less the commanded one.

    ee_error_rms, ee_error_max [m/s]: sqrt(mean |e|^2), max |e|;
    hand_travel, base_travel [m], base_turn [rad]: sum |v| dt of hand (by its positions) and base, sum |w_b| dt;
    outside_s [s]: time with l or psi outside the workspace; outside_l [m], outside_psi [rad]: how far at most;
    authority_changes: how often the greater share went from arm to base or back, mu and sigma together,
    counted where something is commanded; psi_end [rad]: bearing of the hand at the end;
    verdicts: steps per verdict.
    """

    scenario: str
    law: str
    frame: str
    blend: str
    steps: int
    duration: float
    ee_error_rms: float
    ee_error_max: float
    hand_travel: float
    base_travel: float
    base_turn: float
    outside_s: float
    outside_l: float
    outside_psi: float
    authority_changes: int
    psi_end: float
    verdicts: dict[str, int]


def authority_changes(rows: Sequence[Row]) -> int:
    """Count the crossings of mu = 1/2 while v_c is not 0, and of sigma = 1/2 while w_c is not 0."""
    count = 0
    for share, command in (("mu", "v_c"), ("sigma", "w_c")):
        sides = [getattr(row, share) > 0.5 for row in rows if getattr(row, command) != 0.0]
        count += sum(a != b for a, b in pairwise(sides))
    return count


def summarise(
    scenario: Scenario,
    law: str,
    frame: str,
    rows: Sequence[Row],
    errors: Sequence[tuple[float, float]],
    verdicts: dict[Verdict, int],
) -> Summary:
    """Return the summary of a run."""
    dt = scenario.dt
    space = scenario.model.workspace
    size = [hypot(*error) for error in errors]
    beyond_l = [max(row.l - space.l_max, space.l_min - row.l, 0.0) for row in rows]
    beyond_psi = [max(row.psi - space.psi_max, space.psi_min - row.psi, 0.0) for row in rows]
    return Summary(
        scenario=scenario.name,
        law=law,
        frame=frame,
        blend=scenario.blend.name if law != "switch" else "step",
        steps=len(rows),
        duration=len(rows) * dt,
        ee_error_rms=sqrt(sum(e * e for e in size) / len(size)),
        ee_error_max=max(size),
        hand_travel=sum(hypot(b.x_e - a.x_e, b.y_e - a.y_e) for a, b in pairwise(rows)),
        base_travel=sum(abs(row.v_b) for row in rows) * dt,
        base_turn=sum(abs(row.w_b) for row in rows) * dt,
        outside_s=sum(a > 0.0 or b > 0.0 for a, b in zip(beyond_l, beyond_psi, strict=True)) * dt,
        outside_l=max(beyond_l),
        outside_psi=max(beyond_psi),
        authority_changes=authority_changes(rows),
        psi_end=rows[-1].psi,
        verdicts={verdict.value: count for verdict, count in verdicts.items()},
    )


LINES: tuple[tuple[str, str, str], ...] = (
    ("ee_error_rms", "EE velocity error, rms", "m/s"),
    ("ee_error_max", "EE velocity error, max", "m/s"),
    ("hand_travel", "hand path", "m"),
    ("base_travel", "base path", "m"),
    ("base_turn", "base rotation", "rad"),
    ("outside_s", "time outside the workspace", "s"),
    ("outside_l", "  farthest, in l", "m"),
    ("outside_psi", "  farthest, in psi", "rad"),
    ("authority_changes", "authority changes", ""),
    ("psi_end", "psi at the end", "rad"),
)


def table(summary: Summary) -> str:
    """Return the summary as a table to print."""
    head = (
        f"{summary.scenario}: law {summary.law}, frame {summary.frame}, blend {summary.blend}, "
        f"{summary.steps} steps, {summary.duration:g} s"
    )
    body = [f"  {label:<28}{getattr(summary, key):>12.4g}  {unit}".rstrip() for key, label, unit in LINES]
    told = ", ".join(f"{name} {count}" for name, count in summary.verdicts.items())
    return "\n".join([head, *body, f"  verdicts [steps]: {told}"])
