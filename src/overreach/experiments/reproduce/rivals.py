"""Section 4: the same command stream through `exact`, the paper's law and the paper's QP (Fig. 11), and all rivals."""

from __future__ import annotations

from overreach.experiments.reproduce.lab import Lab, Section, Table
from overreach.experiments.reproduce.look import ARM, BASE, HAND, limit, panels, thin
from overreach.experiments.run import Run
from overreach.experiments.summary import LINES, Summary

LAWS = ("exact", "paper", "switch", "separate", "weighted", "qp", "holistic")
DRAWN = ("exact", "paper", "qp")
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
    """Run every law on `mixed` and on `reach`; draw commands to base and joints of three."""
    mixed = {name: lab.run("mixed", name, f"rivals_mixed_{name}") for name in LAWS}
    reach = {name: lab.run("reach", name).summary for name in LAWS}
    figure, axes = panels(4, 3, height=1.6, sharex=True, sharey="row")
    for (name, run), column in zip(((name, mixed[name]) for name in DRAWN), axes.T, strict=True):
        _draw(run, column, name)
    handles, labels = axes[2][0].get_legend_handles_labels()
    figure.legend(handles[-1:], labels[-1:], loc="outside upper right")
    lab.physics["rivals"] = {
        "mixed": {name: _numbers(run.summary) for name, run in mixed.items()},
        "reach": {
            name: {
                "base_travel": one.base_travel,
                "base_turn": one.base_turn,
                "hand_travel": one.hand_travel,
                "ee_error_max": one.ee_error_max,
            }
            for name, one in reach.items()
        },
    }
    qp, ours = mixed["qp"].summary, mixed["exact"].summary
    peers = ", ".join(f"{name} {100 * reach[name].base_travel:.1f}" for name in ("weighted", "qp", "holistic"))
    return Section(
        "rivals",
        "Against optimisation, and against what else one would use",
        [
            "Left to right: what <code>exact</code>, the paper's law and the paper's quadratic program send to base "
            "and joints for the same stick. The QP spreads every command over base and arm at every instant, so that "
            "the base is never at rest while anything is asked. It does not know the workspace: the arm drifts "
            f"{qp.outside_psi:.2f} rad out of it. "
            f"Its peaks here are {qp.peak_v_b:.2f} m/s against {ours.peak_v_b:.2f}, "
            f"and {100 * qp.saturated:.0f} % of its steps are at a limit: with limits this wide we do "
            "<b>not</b> see the saturation that the paper reports. In true kinematics its hand is wrong by "
            f"{qp.ee_error_rms:.2f} m/s rms, because it optimises in the paper's model.",
            "<b>For a reach of 10 cm inside the workspace</b> the laws that share by workspace leave the base where it "
            f"is. The others drive it, in cm: {peers}. "
            "<code>holistic</code>, with true kinematics, is the strongest rival: its hand is "
            f"within {1000 * mixed['holistic'].summary.ee_error_rms:.0f} mm/s rms of what is asked, and the arm stays well "
            "bent. <code>weighted</code> leaves the workspace and ends at the arm's singularity, where it is damped.",
        ],
        [lab.picture("rivals", figure, "Commands to base and joints for the same stick: exact, paper, qp")],
        [
            Table(
                "Scenario <code>mixed</code>, each law in its own frame, true kinematics. Blend: tanh, 50.",
                ("", *LAWS),
                [(WORDS[key], *(getattr(run.summary, key) for run in mixed.values())) for key in FIELDS],
            ),
            Table(
                "A 10 cm reach inside the workspace (scenario <code>reach</code>).",
                ("law", "base path [m]", "base rotation [rad]", "hand path [m]", "error max [m/s]"),
                [
                    (name, one.base_travel, one.base_turn, one.hand_travel, one.ee_error_max)
                    for name, one in reach.items()
                ],
            ),
        ],
    )


def _numbers(summary: Summary) -> dict[str, float]:
    return {key: getattr(summary, key) for key in FIELDS}


def _draw(run: Run, axes: list, name: str) -> None:  # type: ignore[type-arg]  # numpy's array of axes
    model, dt = run.scenario.model, run.scenario.dt
    rows = thin(list(zip(run.rows[:-1], run.rows[1:], strict=True)))
    t = [row.t for row, _ in rows]
    base, arm = model.base, model.arm
    lines = (
        ("$v_b$ [m/s]", [row.v_b for row, _ in rows], BASE, base.v_max),
        ("$ω_b$ [rad/s]", [row.w_b for row, _ in rows], BASE, base.w_max),
        ("joint 1 [rad/s]", [(then.theta_1 - row.theta_1) / dt for row, then in rows], ARM, arm.dtheta_max[0]),
        ("joint 2 [rad/s]", [(then.theta_2 - row.theta_2) / dt for row, then in rows], HAND, arm.dtheta_max[1]),
    )
    for axis, (label, values, colour, most) in zip(axes, lines, strict=True):
        axis.plot(t, values, color=colour, linewidth=1.2)
        limit(axis, (-most, most), "limit of the robot")
        axis.set_ylim(-1.15 * most, 1.15 * most)
        if name == DRAWN[0]:
            axis.set_ylabel(label)
    axes[0].set_title(name)
    axes[3].set_xlabel("t [s]")
