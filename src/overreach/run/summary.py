"""A run in one record, and that record as the table that `overreach simulate` prints."""

from __future__ import annotations

from collections.abc import Sequence

from overreach.law.blend import Step
from overreach.law.body import WholeBody
from overreach.run import metrics
from overreach.run.row import Row
from overreach.run.scenario import Scenario
from overreach.types import Record
from overreach.verdicts import Verdict


class Summary(Record, frozen=True):
    """What happened; formulas and units are in `overreach.run.metrics`.

    ee_error_rms, ee_error_max [m/s]; ee_path_error [m]; hand_travel, base_travel [m]; base_turn [rad];
    peak_v_b [m/s], peak_w_b [rad/s], peak_dtheta [rad/s], peak_ddtheta [rad/s^2] (of the worst joint);
    variation_v_b [m/s], variation_w_b [rad/s]; saturated: part of the steps with a rate at its limit;
    authority_changes, flips_per_s [1/s]; outside_s [s], outside_l [m], outside_psi [rad]: time outside the workspace
    and how far at most; manipulability_min [m^2 in the plane]; psi_end [rad]: bearing at the end; verdicts: steps
    of each.
    """

    scenario: str
    law: str
    frame: str
    blend: str
    steps: int
    duration: float
    ee_error_rms: float
    ee_error_max: float
    ee_path_error: float
    hand_travel: float
    base_travel: float
    base_turn: float
    peak_v_b: float
    peak_w_b: float
    peak_dtheta: float
    peak_ddtheta: float
    variation_v_b: float
    variation_w_b: float
    saturated: float
    authority_changes: int
    flips_per_s: float
    outside_s: float
    outside_l: float
    outside_psi: float
    manipulability_min: float
    psi_end: float
    verdicts: dict[str, int]


def summarise(
    scenario: Scenario, law: WholeBody, rows: Sequence[Row], errors: metrics.Errors, verdicts: dict[Verdict, int]
) -> Summary:
    """Return the summary of a run."""
    dt, model = scenario.dt, scenario.model
    v_b, w_b = metrics.base_speeds(rows, model, dt), [row.w_b for row in rows]
    joints = [metrics.slopes(angles, dt) for angles in zip(*[row.theta for row in rows], strict=True)]
    beyond_l, beyond_psi = metrics.beyond(rows, model.workspace)
    changes = metrics.authority_changes(rows)
    duration = len(rows) * dt
    return Summary(
        scenario=scenario.name,
        law=law.name,
        frame=scenario.frame or law.frame,
        blend=getattr(law, "blend", Step()).name,
        steps=len(rows),
        duration=duration,
        ee_error_rms=metrics.ee_error_rms(errors),
        ee_error_max=metrics.ee_error_max(errors),
        ee_path_error=metrics.ee_path_error(rows, errors, model.mount.yaw, dt),
        hand_travel=metrics.hand_travel(rows),
        base_travel=metrics.travel(v_b, dt),
        base_turn=metrics.travel(w_b, dt),
        peak_v_b=metrics.peak(v_b),
        peak_w_b=metrics.peak(w_b),
        peak_dtheta=max(map(metrics.peak, joints)),
        peak_ddtheta=max(metrics.peak(metrics.slopes(rates, dt)) for rates in joints),
        variation_v_b=metrics.total_variation(v_b),
        variation_w_b=metrics.total_variation(w_b),
        saturated=metrics.saturated(
            zip(v_b[:-1], w_b[:-1], *joints, strict=True) if joints[0] else [(v_b[0], w_b[0], *[0.0] * len(joints))],
            (model.base.v_max, model.base.w_max, *[channel.rate_max for channel in model.arm.channels]),
        ),
        authority_changes=changes,
        flips_per_s=changes / duration,
        outside_s=sum(a > 0.0 or b > 0.0 for a, b in zip(beyond_l, beyond_psi, strict=True)) * dt,
        outside_l=max(beyond_l),
        outside_psi=max(beyond_psi),
        manipulability_min=metrics.manipulability_min(rows, model),
        psi_end=rows[-1].psi,
        verdicts={verdict.value: count for verdict, count in verdicts.items()},
    )


LINES: tuple[tuple[str, str, str], ...] = (
    ("ee_error_rms", "EE velocity error, rms", "m/s"),
    ("ee_error_max", "EE velocity error, max", "m/s"),
    ("ee_path_error", "EE path error", "m"),
    ("hand_travel", "hand path", "m"),
    ("base_travel", "base path", "m"),
    ("base_turn", "base rotation", "rad"),
    ("peak_v_b", "peak |v_b|", "m/s"),
    ("peak_w_b", "peak |w_b|", "rad/s"),
    ("peak_dtheta", "peak joint speed", "rad/s"),
    ("peak_ddtheta", "peak joint acceleration", "rad/s^2"),
    ("variation_v_b", "total variation of v_b", "m/s"),
    ("variation_w_b", "total variation of w_b", "rad/s"),
    ("saturated", "steps with a rate at its limit", "of 1"),
    ("authority_changes", "authority changes", ""),
    ("flips_per_s", "  per second", "1/s"),
    ("outside_s", "time outside the workspace", "s"),
    ("outside_l", "  farthest, in l", "m"),
    ("outside_psi", "  farthest, in psi", "rad"),
    ("manipulability_min", "least manipulability", "m^2"),
    ("psi_end", "psi at the end", "rad"),
)
"""Field, label, unit: in the order in which they are shown."""


def _shown(value: float) -> str:
    """Return `value` to four figures, and 0 for a rounding error."""
    return "0" if abs(value) < 1e-12 else f"{value:.4g}"


def table(summary: Summary) -> str:
    """Return the summary as a table to print."""
    head = (
        f"{summary.scenario}: law {summary.law}, frame {summary.frame}, blend {summary.blend}, "
        f"{summary.steps} steps, {summary.duration:g} s"
    )
    body = [f"  {label:<32}{_shown(getattr(summary, key)):>12}  {unit}".rstrip() for key, label, unit in LINES]
    told = ", ".join(f"{name} {count}" for name, count in summary.verdicts.items())
    return "\n".join([head, *body, f"  verdicts [steps]: {told}"])
