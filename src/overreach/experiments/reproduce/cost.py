"""Section 5: what a step costs, beside the paper's 35.4, 20.7 and 37.5."""

from __future__ import annotations

from overreach.bench.machine import describe
from overreach.bench.run import PAPER, time_steps
from overreach.experiments.reproduce.lab import Lab, Section, Table
from overreach.experiments.reproduce.look import ARM, BASE, MUTED, panels
from overreach.experiments.reproduce.words import number

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
        colour = ARM if name.startswith("exact") else BASE if name.startswith("qp") else MUTED
        axis.barh(k, one["mean"], color=colour, height=0.6)
        axis.plot([one["min"], one["p99"]], [k, k], color=MUTED, linewidth=1.0, marker="|", markersize=7)
        axis.text(max(one["mean"], one["p99"]) * 1.15, k, f"{number(one['mean'])} us", va="center", fontsize=8)
    axis.set(
        yticks=range(len(names)),
        yticklabels=names,
        xscale="log",
        xlabel="time of one whole step [us]: bar mean, line min to p99",
    )
    axis.set_xlim(0.1, max(one["p99"] for one in steps.values()) * 4)
    axis.grid(axis="y", visible=False)
    default = ratios["default_qp"]
    rows: list[tuple[str, float, float, float]] = [
        ("the paper: its law against its QP", PAPER["mean"], PAPER["max"], PAPER["min"])
    ]
    says = (
        "Whole steps, from joint angles and command to base twist and joint rates, timed call by call in turns. "
        f"On this machine ({machine['processor']}, Python {machine['python'].split()[-1]}) the plain Python step of "
        f"<code>exact</code> is {default['mean']:.3g} times as fast as qpsolvers with quadprog in the mean"
    )
    if "fastest_qp" in ratios:
        fastest = ratios["fastest_qp"]
        says += (
            f"; the same source compiled is {fastest['mean']:.3g} times as fast as the fastest of all QPs "
            f"({found['fastest_qp']}), {fastest['max']:.3g} times in the longest call of a round and "
            f"{fastest['min']:.3g} times in the shortest. The single longest calls of the whole run, which are the "
            f"system's doing, are as {number(fastest['worst'])} to 1."
        )
        rows.append(
            (
                f"compiled <code>exact</code> against the fastest QP ({found['fastest_qp']})",
                fastest["mean"],
                fastest["max"],
                fastest["min"],
            )
        )
    else:
        says += ". numba is not installed here: the compiled step was not measured."
    rows.append(
        ("plain <code>exact</code> against qpsolvers + quadprog", default["mean"], default["max"], default["min"])
    )
    return Section(
        "cost",
        "What a step costs",
        [
            says,
            "The paper's ratios compare Python with a QP whose solver it does not name. A modern QP solver is much faster "
            f"than that: daqp's own core takes {found['qp_parts_us']['core']:.2g} us of the "
            f"{found['qp_parts_us']['whole']:.3g} us of a whole step, the rest is the model "
            f"({found['qp_parts_us']['model']:.2g}) and calling ({found['qp_parts_us']['allocation_and_call']:.2g}). "
            "<code>overreach bench</code> measures longer, and many robots at once.",
        ],
        [lab.picture("cost", figure, "Time of one whole step for each law and each QP solver, logarithmic")],
        [
            Table("Times faster: mean, longest call, shortest call.", ("", "mean", "max", "min"), rows),
            Table(
                f"Whole steps [us], medians over {found['rounds']} rounds of {found['samples']} calls.",
                ("step", *COLUMNS),
                [(name, *(one[column] for column in COLUMNS)) for name, one in steps.items()],
            ),
            Table(
                "The law alone [us].",
                ("law", *COLUMNS),
                [(name, *(one[column] for column in COLUMNS)) for name, one in found["law_us"].items()],
            ),
        ],
    )
