"""Section 6c: push straight ahead with the arm to the side. Where does the hand go, where the base?"""

from __future__ import annotations

from math import atan2, cos, sin

from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from overreach.law.laws import Exact, Paper
from overreach.look import ARM, BASE, HAND, MUTED, panels, thin
from overreach.reproduce.lab import Lab, Section
from overreach.run.row import Row
from overreach.run.simulate import Run

AIM = 0.4
"""Where the hand points at the start, and is to go [rad]."""
EVERY_S = 4.0


def section(lab: Lab) -> Section:
    """Drive forward and in reverse with both laws; draw the paths of hand and base."""
    runs = {
        (name, way): lab.run(scenario, law())
        for name, law in (("paper", Paper), ("exact", Exact))
        for way, scenario in (("forward", "aside"), ("reverse", "aside_back"))
    }
    figure, axes = panels(2, 2, height=2.75)
    found = {}
    for axis, ((name, way), run) in zip(axes.flat, runs.items(), strict=True):
        _draw(axis, run, way)
        off = _off(run, way)
        found[f"{name}_{way}"] = {
            "direction_off": off,
            "psi_end": run.summary.psi_end,
            "off_the_line_max": _off_line(run),
            "ee_error_max": run.summary.ee_error_max,
        }
        axis.set_title(f"{name}, {way}: the hand goes {abs(off):.3f} rad off")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=5)
    lab.physics["straight"] = found
    his, ours = found["paper_forward"], found["exact_forward"]
    return Section(
        "straight",
        "What the paper does not show: push straight ahead",
        [
            "The arm points 0.4 rad to the left, the stick says forward. The hand should go along the thin grey line. With the "
            f"paper's law it goes {abs(his['direction_off']):.3f} rad off, forward as in reverse: the base drives along "
            "its own axis, with the arm out to the side. With <code>exact</code> the hand stays on "
            f"its line to {1000 * ours['off_the_line_max']:.1f} mm (the base's arcs within a step), while the base turns in behind it: "
            f"at the end the arm points straight ahead (ψ = {ours['psi_end']:.3f} rad). Reversing is stable too."
        ],
        [lab.picture("straight", figure, "Paths of hand and base: paper and exact, forward and reverse")],
    )


def _direction(run: Run) -> float:
    """Return the direction [rad] in which the hand went over the last quarter of the run."""
    a, b = run.rows[3 * len(run.rows) // 4], run.rows[-1]
    return atan2(b.y_e - a.y_e, b.x_e - a.x_e)


def _off(run: Run, way: str) -> float:
    """Return the angle [rad] between where the hand went and where it was sent."""
    turned = _direction(run) - AIM - (0.0 if way == "forward" else -atan2(0.0, -1.0))
    return atan2(sin(turned), cos(turned))


def _off_line(run: Run) -> float:
    """Return how far [m] the hand was off its line at most."""
    first = run.rows[0]
    return max(abs(-(row.x_e - first.x_e) * sin(AIM) + (row.y_e - first.y_e) * cos(AIM)) for row in run.rows)


def _draw(axis: Axes, run: Run, way: str) -> None:
    rows = thin(run.rows, 400)
    first = run.rows[0]
    sign = 1.0 if way == "forward" else -1.0
    far = 8.6
    axis.plot(
        [first.x_e, first.x_e + sign * far * cos(AIM)],
        [first.y_e, first.y_e + sign * far * sin(AIM)],
        color=MUTED, linewidth=0.9, label="where it was sent",
    )  # fmt: skip
    axis.plot([row.x_e for row in rows], [row.y_e for row in rows], color=HAND, label="hand")
    axis.plot([row.x_b for row in rows], [row.y_b for row in rows], color=BASE, label="base")
    stride = round(EVERY_S / run.scenario.dt)
    for k, row in enumerate(run.rows[::stride] + run.rows[-1:]):
        _robot(axis, run, row, "arm" if k == 0 else None)
    axis.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    axis.set_xlim((-0.9, 9.4) if way == "forward" else (-9.0, 1.3))
    axis.set_ylim((-0.8, 3.9) if way == "forward" else (-3.9, 0.8))


def _robot(axis: Axes, run: Run, row: Row, label: str | None) -> None:
    """Draw base and arm as they stood."""
    model = run.scenario.model
    long, wide = model.base.footprint
    c, s = cos(row.theta_b), sin(row.theta_b)
    corners = [(a * long / 2, b * wide / 2) for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
    axis.add_patch(
        Polygon(
            [(row.x_b + c * x - s * y, row.y_b + s * x + c * y) for x, y in corners],
            facecolor=f"{BASE}22", edgecolor=BASE, linewidth=0.8,
        )
    )  # fmt: skip
    axis.plot([row.x_b, row.x_b + c * long / 2], [row.y_b, row.y_b + s * long / 2], color=BASE, linewidth=0.8)
    links = [
        (row.x_b + c * x - s * y, row.y_b + s * x + c * y) for x, y, _ in model.arm.at(row.theta, model.mount).points
    ]
    axis.plot(*zip(*links, strict=True), color=ARM, linewidth=1.3, label=label)
    axis.plot(row.x_e, row.y_e, "o", color=HAND, markersize=3.5)
