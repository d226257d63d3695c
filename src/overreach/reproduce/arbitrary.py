"""Section 3: an arbitrary drive, the paper's Fig. 10, measured in true kinematics."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin

from matplotlib.axes import Axes

from overreach.law.blend import Tanh
from overreach.law.laws import Exact, Paper
from overreach.look import ARM, BASE, HAND, INK, MUTED, STOP, panels, thin
from overreach.reproduce.lab import Lab, Section
from overreach.run.simulate import Run


def section(lab: Lab) -> Section:
    """Run `mixed` with `paper` and `exact`, draw shares and errors side by side."""
    runs = {"paper": lab.run("mixed", Paper(blend=Tanh())), "exact": lab.run("mixed", Exact(blend=Tanh()))}
    figure, axes = panels(4, 2, sharex=True, sharey="row", height=1.7)
    for (name, run), column in zip(runs.items(), axes.T, strict=True):
        _draw(run, column, name)
    handles, labels = axes[1][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4)
    summaries = {name: run.summary for name, run in runs.items()}
    lab.physics["arbitrary"] = {
        name: {
            "ee_error_rms": one.ee_error_rms,
            "ee_error_max": one.ee_error_max,
            "ee_path_error": one.ee_path_error,
            "peak_v_b": one.peak_v_b,
        }
        for name, one in summaries.items()
    }
    his, ours = summaries["paper"], summaries["exact"]
    return Section(
        "arbitrary",
        "An arbitrary drive: does the hand do what it is told?",
        [
            "Linear and angular commands together, in both directions, for 20 s; both laws with the paper's tanh, α = β = 50. The dashed line is what was "
            "commanded; the violet one is how the hand <b>truly</b> moves when base and arm are rigid bodies. The "
            "shares of base and arm are smooth with both laws. But the paper's sum is exact only in its own model, "
            "which leaves out that a base driving forward also carries a hand that is off its axis sideways: its hand "
            f"is wrong by up to {his.ee_error_max:.2f} m/s ({his.ee_error_rms:.3f} rms) and is led "
            f"up to {his.ee_path_error:.2f} m off its path. With <code>exact</code> the greatest error is "
            f"{ours.ee_error_max:.0e} m/s. It asks more of the base's turning for that: up to {ours.peak_w_b:.2f} "
            f"rad/s, against {his.peak_w_b:.2f}."
        ],
        [
            lab.picture(
                "arbitrary",
                figure,
                "Scenario mixed, tanh 50: commands, shares, the hand's true motion; paper and exact, each in its own frame",
            )
        ],
    )


def _draw(run: Run, axes: Sequence[Axes], name: str) -> None:
    pairs = thin(list(zip(run.rows, run.errors, strict=True)))
    t = [row.t for row, _ in pairs]
    axes[0].plot(t, [row.v_c for row, _ in pairs], color=INK, label="$v_c$ [m/s]")
    axes[0].plot(t, [row.w_c for row, _ in pairs], color=MUTED, label="$ω_c$ [rad/s]")
    axes[0].set_title(f"law {name}, frame {run.summary.frame}: command")

    true_r = [row.v_b * cos(row.psi) + row.v_m for row, _ in pairs]
    asked_r = [r - e[0] for r, (_, e) in zip(true_r, pairs, strict=True)]
    axes[1].plot(t, [row.v_b * cos(row.psi) for row, _ in pairs], color=BASE, linewidth=1.1, label="by the base")
    axes[1].plot(t, [row.v_m for row, _ in pairs], color=ARM, linewidth=1.1, label="by the arm")
    axes[1].plot(t, true_r, color=HAND, label="hand, true")
    axes[1].plot(t, asked_r, color=INK, linestyle=(0, (3, 3)), linewidth=1.1, label="commanded")
    axes[1].set_title("outward (radial)")

    true_t = [-row.v_b * sin(row.psi) / row.l + row.w_b + row.w_m for row, _ in pairs]
    asked_t = [r - e[1] / row.l for r, (row, e) in zip(true_t, pairs, strict=True)]
    by_base = [-row.v_b * sin(row.psi) / row.l + row.w_b for row, _ in pairs]
    axes[2].plot(t, by_base, color=BASE, linewidth=1.1, label="by the base")
    axes[2].plot(t, [row.w_m for row, _ in pairs], color=ARM, linewidth=1.1, label="by the arm")
    axes[2].plot(t, true_t, color=HAND, label="hand, true")
    axes[2].plot(t, asked_t, color=INK, linestyle=(0, (3, 3)), linewidth=1.1, label="commanded")
    axes[2].set_title("around the shoulder (tangential / l)")
    axes[2].set_ylim(-1.8, 2.2)

    size = [(e_r * e_r + e_t * e_t) ** 0.5 for _, (e_r, e_t) in pairs]
    axes[3].plot(t, size, color=STOP, label="|true - commanded|")
    axes[3].set_title(f"error of the hand's velocity: at most {run.summary.ee_error_max:.2g} m/s")
    axes[3].set_xlabel("t [s]")
    if name == "paper":
        for axis, label in zip(axes, ("[m/s], [rad/s]", "[m/s]", "[rad/s]", "[m/s]"), strict=True):
            axis.set_ylabel(label)
    axes[0].legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=2, borderaxespad=0.0, handlelength=1.2)
