"""Section 5: what a step costs, beside the paper's 35.4, 20.7 and 37.5."""

from __future__ import annotations

from typing import Any

from overreach.bench.machine import describe
from overreach.bench.run import PAPER, time_steps
from overreach.look import ARM, BASE, HAND, MUTED, panels
from overreach.reproduce.lab import Lab, Section, Table
from overreach.reproduce.words import number

ROUNDS, SAMPLES = 5, 300
COLUMNS = ("mean", "p50", "p99", "max", "min")


def section(lab: Lab) -> Section:
    """Time laws, whole steps and solvers in turns; nothing else runs meanwhile."""
    found = time_steps(ROUNDS, SAMPLES)
    machine = describe()
    lab.timing.update({"machine": machine, **found})
    steps, ratios = found["steps_us"], found["ratios"]
    figure, axes = panels(1, 1, height=3.6)
    names = sorted(steps, key=lambda name: -steps[name]["mean"])
    axis = axes[0][0]
    for k, name in enumerate(names):
        one = steps[name]
        colour = ARM if name.startswith("exact") else BASE if name.startswith("qp") else HAND
        axis.plot([one["min"], one["p99"]], [k, k], color=MUTED, linewidth=1.0, marker="|", markersize=7)
        axis.plot(one["mean"], k, "o", color=colour, markersize=7)
        axis.text(max(one["mean"], one["p99"]) * 1.2, k, f"{number(one['mean'])} µs", va="center", fontsize=8)
    axis.set(
        yticks=range(len(names)),
        yticklabels=names,
        xscale="log",
        xlabel="time of one whole step [µs]: dot mean, line shortest call to p99",
    )
    axis.set_xlim(min(one["min"] for one in steps.values()) / 2, max(one["p99"] for one in steps.values()) * 4)
    axis.grid(axis="y", visible=False)
    default, his = ratios["default_qp"], steps["paper, plain"]["mean"]
    rows: list[tuple[str, ...]] = [
        ("the paper's own: its law against its QP", *(f"{PAPER[key]:g}" for key in ("mean", "max", "min")))
    ]
    says = (
        "Whole steps, from joint angles and command to base twist and joint rates, in turns. "
        f"On this machine ({machine['processor']}, Python {machine['python'].split()[-1]}) the paper's law takes "
        f"{number(his)} µs in plain Python and <code>exact</code> {number(steps['exact, plain']['mean'])} µs, "
        f"{default['mean']:.0f} times less than qpsolvers with quadprog"
    )
    if "fastest_qp" in ratios:
        fastest = ratios["fastest_qp"]
        low, high = fastest["spread"]["mean"]
        says += (
            f". The same source compiled is {fastest['mean']:.0f} times as fast (quartiles {low:.0f} to {high:.0f}) as the "
            f"fastest of the QPs measured, {found['fastest_qp']}, called from Python as it is; of its "
            f"{number(steps['exact, compiled']['mean'])} µs an empty call is {number(steps['exact, compiled: empty call']['mean'])}."
        )
        label = f"compiled <code>exact</code> against the fastest QP measured ({found['fastest_qp']})"
        rows.append((label, *_with_spread(fastest)))
    else:
        says += ". numba is not installed here: the compiled step was not measured."
    rows.append(("plain <code>exact</code> against qpsolvers + quadprog", *_with_spread(default)))
    return Section(
        "cost",
        "What a step costs",
        [
            says,
            "The paper does not name its solver, and that decides: the fastest here is daqp called directly, with the model "
            "written out in closed form; the slowest are those made for large sparse problems. Python is most of "
            f"it: daqp's own C core takes {found['qp_parts_us']['core']:.2g} µs of the "
            f"{found['qp_parts_us']['whole']:.3g} µs of a whole step (daqp-direct), the rest is the model "
            f"({found['qp_parts_us']['model']:.2g}) and calling ({found['qp_parts_us']['allocation_and_call']:.2g}). "
            "Core against core, compiled, the two are close. The QP holds the robot's speed limits in its bounds, our step "
            "leaves them to the loop (“in the loop”, with records and all). "
            "<code>overreach bench</code> measures longer, and many robots at once.",
        ],
        [lab.picture("cost", figure, "Time of one whole step for each law and each QP solver, logarithmic scale")],
        [
            Table(
                "Times faster: mean, longest call of a round, shortest; medians over rounds, with quartiles.",
                ("", "mean", "max", "min"),
                rows,
            ),
            Table(
                f"Whole steps [µs], medians over {found['rounds']} rounds of {found['samples']} calls (osqp, clarabel: one round). The mean is of calls without a clock between; the others are of single calls, which a clock that is read makes longer.",
                ("step", *COLUMNS),
                [(name, *(one[column] for column in COLUMNS)) for name, one in steps.items()],
            ),
            Table(
                "One decision of the law alone [µs]; qp and holistic with daqp-direct.",
                ("law", *COLUMNS),
                [(name, *(one[column] for column in COLUMNS)) for name, one in found["law_us"].items()],
            ),
        ],
    )


def _with_spread(ratios: dict[str, Any]) -> tuple[str, str, str]:
    """Return mean, max and min as text, each with its quartiles."""
    cells = []
    for key in ("mean", "max", "min"):
        low, high = ratios["spread"][key]
        cells.append(f"{ratios[key]:.0f} ({low:.0f} to {high:.0f})")
    return cells[0], cells[1], cells[2]
