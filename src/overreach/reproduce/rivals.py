"""Section 4: the same command stream through `exact`, the paper's law and the paper's QP (Fig. 11), and all rivals."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

import msgspec
from matplotlib.axes import Axes

from overreach.baselines.weighted import Weighted
from overreach.look import ARM, BASE, HAND, limit, panels, thin
from overreach.reproduce.lab import Lab, Section, Table
from overreach.run.scenario import Scenario, load_scenario
from overreach.run.simulate import Run, simulate
from overreach.run.summary import LINES, Summary
from overreach.types import Frame

LAWS = ("exact", "paper", "switch", "separate", "weighted", "qp", "holistic")
DRAWN = ("exact", "paper", "qp", "holistic")
WEIGHTS = (0.3, 1.0, 10.0, 100.0)
FIELDS = (
    "ee_error_rms", "ee_error_max", "ee_path_error", "base_travel", "base_turn", "peak_v_b", "peak_w_b", "peak_dtheta",
    "peak_ddtheta", "variation_v_b", "variation_w_b", "saturated", "flips_per_s", "outside_s", "outside_l", "outside_psi",
    "manipulability_min",
)  # fmt: skip
WORDS = {key: f"{label.strip()} [{unit}]" if unit else label.strip() for key, label, unit in LINES} | {
    "saturated": "steps with a rate at its limit [of 1]",
    "flips_per_s": "authority changes [1/s]",
    "outside_l": "farthest outside in l [m]",
    "outside_psi": "farthest outside in ψ [rad]",
}


def section(lab: Lab) -> Section:
    """Run every law on `mixed` and on `reach`; draw commands to base and joints of four."""
    mixed_polar, reach_polar = (in_polar(name) for name in ("mixed", "reach"))
    mixed = {name: lab.run(mixed_polar, name, f"rivals_mixed_{name}") for name in LAWS}
    reaching = {name: lab.run(reach_polar, name) for name in LAWS}
    reach = {name: run.summary for name, run in reaching.items()}
    net = {name: _net(run) for name, run in reaching.items()}
    weights = {weight: _weighted(weight, mixed_polar, reach_polar) for weight in WEIGHTS}
    figure, axes = panels(4, 4, height=1.6, width=10.4, sharex=True, sharey="row")
    for (name, run), column in zip(((name, mixed[name]) for name in DRAWN), axes.T, strict=True):
        _draw(run, column, name)
    handles, labels = axes[2][0].get_legend_handles_labels()
    figure.legend(handles[-1:], labels[-1:], loc="outside upper right")
    lab.physics["rivals"] = {
        "mixed": {name: _numbers(run.summary) for name, run in mixed.items()},
        "reach": {
            name: {
                "base_travel": one.base_travel,
                "base_net_travel": net[name],
                "base_turn": one.base_turn,
                "hand_travel": one.hand_travel,
                "ee_error_max": one.ee_error_max,
            }
            for name, one in reach.items()
        },
        "weights": {f"{weight:g}": values for weight, values in weights.items()},
    }
    qp, ours = mixed["qp"].summary, mixed["exact"].summary
    peers = ", ".join(
        f"{name} {100 * reach[name].base_travel:.1f} ({100 * net[name]:.1f})" for name in ("weighted", "qp", "holistic")
    )
    return Section(
        "rivals",
        "Against optimisation, and against what else one would use",
        [
            "Left to right: what <code>exact</code>, the paper's law, the paper's quadratic program and holistic control "
            "send to base and joints for the same stick, all in the paper's frame (<code>polar</code>), the sharing laws "
            "with its tanh. The QP spreads every command over base and arm at every instant, so that "
            "the base is never at rest while anything is asked. It does not know the workspace: the arm goes "
            f"{qp.outside_psi:.2f} rad out of it. Its peaks here are {qp.peak_v_b:.2f} m/s against {ours.peak_v_b:.2f}, and "
            f"{100 * qp.saturated:.0f} % of its steps are at a limit: with limits this wide we do <b>not</b> see the "
            f"saturation that the paper reports. Its hand is wrong by {qp.ee_error_rms:.2f} m/s rms, because it optimises "
            "in the paper's model.",
            f"<b>For a reach of 10 cm inside the workspace</b> the laws that share by workspace leave the base where it is. "
            f"The others drive it, in cm of path (and net): {peers}. <code>holistic</code>, with true kinematics, is the "
            f"strongest rival: its hand is within {1000 * mixed['holistic'].summary.ee_error_rms:.0f} mm/s rms of what is "
            "asked, the arm stays well bent and within the workspace. <code>weighted</code>, the plain pseudo-inverse, is "
            "<b>as exact as ours</b> where nothing is singular. What it lacks is a workspace: the arm goes "
            f"{mixed['weighted'].summary.outside_psi:.2f} rad and {100 * mixed['weighted'].summary.outside_l:.0f} cm out, the "
            f"base drives {100 * reach['weighted'].base_travel:.0f} cm for the reach. A dearer base drives less, "
            "and meets the arm's end; a cheaper one keeps the arm in, and drives for everything (last table).",
            "What is not free with <code>exact</code>: it turns the base more, total variation of its rotation "
            f"{ours.variation_w_b:.1f} against {mixed['paper'].summary.variation_w_b:.1f} rad/s. No limits are in force here "
            "but those that a QP has in it; commands are steps, so that joint accelerations are those of a step in 1 ms, "
            "and mean nothing in themselves. On a robot the loop's limits hold for every law alike.",
        ],
        [lab.picture("rivals", figure, "Commands to base and joints for the same stick: exact, paper, qp, holistic")],
        [
            Table(
                "Scenario <code>mixed</code>, all in the frame <code>polar</code>, true kinematics. Blend: tanh, 50.",
                ("", *LAWS),
                [(WORDS[key], *(getattr(run.summary, key) for run in mixed.values())) for key in FIELDS],
            ),
            Table(
                "A 10 cm reach inside the workspace (scenario <code>reach</code>).",
                ("law", "base path [m]", "base, net [m]", "base rotation [rad]", "hand path [m]", "error max [m/s]"),
                [
                    (name, one.base_travel, net[name], one.base_turn, one.hand_travel, one.ee_error_max)
                    for name, one in reach.items()
                ],
            ),
            Table(
                "The pseudo-inverse with other weights of the base against a joint.",
                ("weight", *WEIGHT_COLUMNS.values()),
                [(f"{weight:g}", *(values[key] for key in WEIGHT_COLUMNS)) for weight, values in weights.items()],
            ),
        ],
    )


WEIGHT_COLUMNS = {
    "ee_error_max": "error max [m/s]",
    "outside_l": "outside in l [m]",
    "outside_psi": "outside in ψ [rad]",
    "peak_v_b": "peak v_b [m/s]",
    "reach": "base path for the reach [m]",
}


def in_polar(name: str) -> Scenario:
    """Return a scenario in the paper's frame, in which every law can be asked the same."""
    return msgspec.structs.replace(load_scenario(name), frame=Frame.POLAR)


def _net(run: Run) -> float:
    """Return how far [m] the base stands from where it stood."""
    a, b = run.rows[0], run.rows[-1]
    return hypot(b.x_b - a.x_b, b.y_b - a.y_b)


def _weighted(weight: float, mixed: Scenario, reach: Scenario) -> dict[str, float]:
    law = Weighted(base_weight=weight)
    one = simulate(mixed, law).summary
    return {key: getattr(one, key) for key in WEIGHT_COLUMNS if key != "reach"} | {
        "reach": simulate(reach, law).summary.base_travel
    }


def _numbers(summary: Summary) -> dict[str, float]:
    return {key: getattr(summary, key) for key in FIELDS}


def _draw(run: Run, axes: Sequence[Axes], name: str) -> None:
    model, dt = run.scenario.model, run.scenario.dt
    rows = thin(list(zip(run.rows[:-1], run.rows[1:], strict=True)))
    t = [row.t for row, _ in rows]
    base = model.base
    one, two = [joint.rate_max for joint in model.arm.channels]
    lines = (
        ("$v_b$ [m/s]", [row.v_b for row, _ in rows], BASE, base.v_max),
        ("$ω_b$ [rad/s]", [row.w_b for row, _ in rows], BASE, base.w_max),
        ("joint 1 [rad/s]", [(then.theta[0] - row.theta[0]) / dt for row, then in rows], ARM, one),
        ("joint 2 [rad/s]", [(then.theta[1] - row.theta[1]) / dt for row, then in rows], HAND, two),
    )
    for axis, (label, values, colour, most) in zip(axes, lines, strict=True):
        axis.plot(t, values, color=colour, linewidth=1.2)
        limit(axis, (-most, most), "limit of the robot")
        axis.set_ylim(-1.15 * most, 1.15 * most)
        if name == DRAWN[0]:
            axis.set_ylabel(label)
    axes[0].set_title(name)
    axes[3].set_xlabel("t [s]")
