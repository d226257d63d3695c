"""What a run is measured by: one function each, with its formula and unit.

Rows are the steps of a run, dt [s] apart; errors are, per step, e = the EE's true rigid-body velocity less the
commanded one, in polar components [m/s]. Sums stand for integrals: every rate is held for its step.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import cos, hypot, sin, sqrt
from statistics import median

from overreach.clock import nanoseconds
from overreach.law.body import WholeBody
from overreach.law.frame import FRAMES, meant, of_two
from overreach.model.model import Model
from overreach.model.workspace import Workspace
from overreach.run.row import Row
from overreach.types import Frame, Twist

MOST_CALLS = 2_000
"""Steps of a run on which its law is timed."""

ARM_BELOW, BASE_ABOVE = 0.25, 0.75
"""A share below the first counts as the arm's, above the second as the base's; in between nothing changes hands."""

Errors = Sequence[tuple[float, float]]


def ee_error_rms(errors: Errors) -> float:
    """Return sqrt(mean |e|^2) [m/s]."""
    return sqrt(sum(e_r * e_r + e_t * e_t for e_r, e_t in errors) / len(errors))


def ee_error_max(errors: Errors) -> float:
    """Return max |e| [m/s]."""
    return max(hypot(*error) for error in errors)


def ee_path_error(rows: Sequence[Row], errors: Errors, yaw: float, dt: float) -> float:
    """Return max over t of |integral of e| [m], e turned into the world: how far the hand was led off its command."""
    x = y = worst = 0.0
    for row, (e_r, e_t) in zip(rows, errors, strict=True):
        bearing = row.theta_b + row.psi + yaw
        c, s = cos(bearing), sin(bearing)
        x += (e_r * c - e_t * s) * dt
        y += (e_r * s + e_t * c) * dt
        worst = max(worst, hypot(x, y))
    return worst


def hand_travel(rows: Sequence[Row]) -> float:
    """Return sum |p_e(k+1) - p_e(k)| [m]: the hand's path, by its positions."""
    return sum(hypot(b.x_e - a.x_e, b.y_e - a.y_e) for a, b in pairwise(rows))


def travel(rates: Iterable[float], dt: float) -> float:
    """Return sum |rate| dt: path of the base [m] of v_b, rotation of the base [rad] of w_b."""
    return sum(abs(rate) for rate in rates) * dt


def peak(values: Iterable[float]) -> float:
    """Return max |value|, in the value's unit."""
    return max((abs(value) for value in values), default=0.0)


def slopes(values: Sequence[float], dt: float) -> list[float]:
    """Return (x(k+1) - x(k))/dt: rates of positions, accelerations of rates."""
    return [(b - a) / dt for a, b in pairwise(values)]


def total_variation(values: Sequence[float]) -> float:
    """Return sum |x(k+1) - x(k)|, in the value's unit: the total of all changes, back and forth."""
    return sum(abs(b - a) for a, b in pairwise(values))


def authority_changes(rows: Sequence[Row]) -> int:
    """Count how often mu or sigma passes from arm (< 1/4) to base (> 3/4) or back, while its command is not 0."""
    return _changes(row.mu for row in rows if row.v_c != 0.0) + _changes(row.sigma for row in rows if row.w_c != 0.0)


def _changes(shares: Iterable[float]) -> int:
    count, side = 0, 0
    for share in shares:
        now = 1 if share > BASE_ABOVE else -1 if share < ARM_BELOW else side
        count += now * side < 0
        side = now
    return count


def beyond(rows: Sequence[Row], space: Workspace) -> tuple[list[float], list[float]]:
    """Return, per step, how far l [m] and psi [rad] are outside the workspace; 0 inside."""
    return (
        [max(row.l - space.l_max, space.l_min - row.l, 0.0) for row in rows],
        [max(row.psi - space.psi_max, space.psi_min - row.psi, 0.0) for row in rows],
    )


def manipulability_min(rows: Sequence[Row], model: Model) -> float:
    """Return min sqrt(det(J J^T)) of the arm, in m^2 for one in the plane: 0 where it is singular."""
    return min(model.arm.at(row.theta, model.mount).manipulability for row in rows)


def base_speeds(rows: Sequence[Row], model: Model, dt: float) -> list[float]:
    """Return the base's speed [m/s] at each row: forward, of one that moves sideways too along its way."""
    if not model.base.omni:
        return [row.v_b for row in rows]
    ways = [hypot(b.x_b - a.x_b, b.y_b - a.y_b) / dt for a, b in pairwise(rows)]
    return [*ways, *ways[-1:]] or [0.0]


def saturated(rates: Iterable[tuple[float, ...]], most: tuple[float, ...]) -> float:
    """Return the part of the steps in which at least one rate is at its limit (within 1e-6 of it)."""
    held = [any(abs(rate) >= top * (1.0 - 1e-6) for rate, top in zip(step, most, strict=True)) for step in rates]
    return sum(held) / len(held)


def cost_per_step(law: WholeBody, frame: Frame, rows: Sequence[Row], model: Model) -> float:
    """Return the median time of one plan of `law` [us], over the states and commands of a run, evenly picked.

    Unlike the rest it is measured, not computed, so it differs from run to run. `overreach bench` does it with care.
    """
    angle, plan, took = FRAMES[frame], law.planner(model), []
    for row in rows[:: max(1, len(rows) // MOST_CALLS)]:
        u = meant(angle, of_two(frame, row.v_c, row.w_c), row.l, row.psi + model.mount.yaw, row.theta_b, row.theta_e)
        chain, base = model.arm.at(row.theta, model.mount), Twist(row.v_b, w_z=row.w_b)
        start = nanoseconds()
        plan(chain, u, base)
        took.append(nanoseconds() - start)
    return median(took) / 1000.0
