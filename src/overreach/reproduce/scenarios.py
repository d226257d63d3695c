"""Section 2: scenarios 1 to 4, the paper's Fig. 9: outward, inward, left, right, and back."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from scipy.special import wrightomega

from overreach.law.laws import Exact
from overreach.look import ARM, BASE, HAND, INK, MUTED, limit, thin
from overreach.reproduce.lab import Lab, Picture, Section
from overreach.run.simulate import Run

NAMES = ("outward", "inward", "left", "right")
TITLES = {
    "outward": "Scenario 1, outward",
    "inward": "Scenario 2, inward",
    "left": "Scenario 3, left",
    "right": "Scenario 4, right",
}


def closed_form(run: Run) -> tuple[Any, Any, Any]:
    """Return (t [s], the arm's coordinate as the closed form gives it, as it was) while the first command is held.

    e, the distance beyond the limit ahead, obeys de/dt = v/(1 + exp(2 a e)), so that 2 a e = ln omega(2 a (v t + C)),
    with C = e0 + exp(2 a e0)/(2 a) and omega Wright's function. The same for l with alpha, for psi with beta.
    """
    scenario = run.scenario
    first = scenario.segments[0]
    until = scenario.segments[1].t
    space, blend = scenario.model.workspace, scenario.blend
    linear = first.v_c != 0.0
    command = first.v_c if linear else first.w_c
    sharp = blend.k_l if linear else blend.k_psi
    ends = (space.l_min, space.l_max) if linear else (space.psi_min, space.psi_max)
    limit_ahead = ends[1] if command > 0.0 else ends[0]
    sign = 1.0 if command > 0.0 else -1.0
    rows = [row for row in run.rows if row.t <= until]
    t = np.array([row.t for row in rows])
    was = np.array([row.l if linear else row.psi for row in rows])
    e0 = sign * (was[0] - limit_ahead)
    constant = e0 + np.exp(2.0 * sharp * e0) / (2.0 * sharp)
    e = np.log(wrightomega(2.0 * sharp * (abs(command) * t + constant)).real) / (2.0 * sharp)
    return t, limit_ahead + sign * e, was


def draw(lab: Lab, run: Run) -> Picture:
    """Draw one scenario: time histories on the left, the phase plot of what is commanded on the right."""
    name = run.scenario.name
    space = run.scenario.model.workspace
    figure = plt.figure(figsize=(9.2, 5.6))
    beside: Any = figure.subfigures(1, 2, width_ratios=(1.5, 1.0))
    left = beside[0].subplots(4, 1, sharex=True)
    right = beside[1].subplots(1, 1)
    rows = thin(run.rows)
    t = [row.t for row in rows]
    linear = run.scenario.segments[0].v_c != 0.0
    when, formula, _ = closed_form(run)
    lengths, bearings = (space.l_min, space.l_max), (space.psi_min, space.psi_max)

    left[0].plot(t, [row.l for row in rows], color=HAND, label="l")
    limit(left[0], lengths, "limits")
    left[0].set(ylabel="l [m]", ylim=(0.35, 0.95))
    left[1].plot(t, [row.psi for row in rows], color=HAND, label="ψ")
    limit(left[1], bearings, "limits")
    left[1].set(ylabel="ψ [rad]", ylim=(-0.85, 0.85))
    which = left[0] if linear else left[1]
    which.plot(thin(when, 60), thin(formula, 60), ".", color=INK, markersize=2.5, label="closed form")
    for axis, (base, arm, command), unit, names in (
        (left[2], ("v_b", "v_m", "v_c"), "m/s", ("$v_b$ (base)", "$v_m$ (arm)", "$v_c$ (command)")),
        (left[3], ("w_b", "w_m", "w_c"), "rad/s", ("$ω_b$ (base)", "$ω_m$ (arm)", "$ω_c$ (command)")),
    ):
        asked = [getattr(row, command) for row in rows]
        axis.plot(t, asked, color=MUTED, linewidth=1.0, linestyle="--", label=names[2])
        axis.plot(t, [getattr(row, base) for row in rows], color=BASE, label=names[0])
        axis.plot(t, [getattr(row, arm) for row in rows], color=ARM, label=names[1])
        axis.set(ylabel=f"rate [{unit}]", ylim=(-0.48, 0.48))
    left[3].set_xlabel("t [s]")
    for axis in left:
        axis.legend(loc="lower left", bbox_to_anchor=(0.0, 0.98), ncols=3, borderaxespad=0.0, handlelength=1.4)

    where, base, arm, ends, x_label, unit, pair = (
        ("l", "v_b", "v_m", lengths, "l [m]", "m/s", ("$v_b$ (base)", "$v_m$ (arm)"))
        if linear
        else ("psi", "w_b", "w_m", bearings, "ψ [rad]", "rad/s", ("$ω_b$ (base)", "$ω_m$ (arm)"))
    )
    x = [getattr(row, where) for row in rows]
    right.plot(x, [getattr(row, base) for row in rows], color=BASE, label=pair[0])
    right.plot(x, [getattr(row, arm) for row in rows], color=ARM, label=pair[1])
    limit(right, ends, "limits", horizontal=False)
    margin = 0.1 if linear else 0.25
    right.set(xlabel=x_label, ylabel=f"rate [{unit}]", xlim=(ends[0] - margin, ends[1] + margin), ylim=(-0.48, 0.48))
    right.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, borderaxespad=0.0, handlelength=1.4)
    idle = "ψ and its rates stay" if linear else "the linear rates stay"
    return lab.picture(
        f"scenario_{name}",
        figure,
        f"{TITLES[name]}: time histories and phase plot, law paper, tanh with α = β = 50; dots: closed form; "
        f"{idle} at 0, their phase plot is a point",
    )


def section(lab: Lab) -> Section:
    """Run and draw the four scenarios, and check them against the closed form and against `exact`."""
    pictures = []
    found = {}
    for name in NAMES:
        run = lab.run(name, "paper")
        same = lab.run(name, Exact(blend=run.scenario.blend))
        pictures.append(draw(lab, run))
        _, formula, was = closed_form(run)
        space = run.scenario.model.workspace
        found[name] = {
            "closed_form_error_max": float(np.max(np.abs(formula - was))),
            "exact_differs_from_paper_by": max(
                max(abs(a.l - b.l), abs(a.psi - b.psi)) for a, b in zip(run.rows, same.rows, strict=True)
            ),
            "beyond_the_limit": max(run.summary.outside_l, run.summary.outside_psi),
            "ends_inside": space.contains(run.rows[-1].l, run.rows[-1].psi, 0.1, 0.1),
            "base_travel": run.summary.base_travel,
            "base_turn": run.summary.base_turn,
            "ee_error_max": run.summary.ee_error_max,
            "authority_changes": run.summary.authority_changes,
        }
    lab.physics["scenarios"] = found
    worst = max(one["closed_form_error_max"] for one in found.values())
    differs = max(one["exact_differs_from_paper_by"] for one in found.values())
    return Section(
        "scenarios",
        "Straight out, straight in, left, right",
        [
            "The hand is sent at 0.4 m/s or 0.4 rad/s from inside the workspace through one limit, back by "
            "reversing through the other, and forward again. The arm moves until its limit is near, the base takes "
            "over, and on reversing the arm comes back at once. <b>Here the paper's law does what it promises</b>: straight along the "
            "base's axis its model and true kinematics agree. The simulation follows the closed form (Wright's omega) "
            f"to {worst:.1e} m or rad, and <code>exact</code> does the same to {differs:.0e}. In the phase plots base "
            "and arm cross over at the limit, and the way out is not the way back."
        ],
        pictures,
    )
