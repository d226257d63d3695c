"""What was measured, as the text that `overreach bench` prints."""

from __future__ import annotations

from typing import Any

from overreach.bench.run import PAPER

COLUMNS = ("mean", "p50", "p99", "max", "min", "worst")


def text(found: dict[str, Any]) -> str:
    """Return the report."""
    blocks = [
        _machine(found["machine"]),
        _table("The law alone [us]", found["law_us"]),
        _table("Whole step: joints and command to base twist and joint rates [us]", found["steps_us"]),
        _parts(found),
        _ratios(found),
    ]
    if "batch" in found:
        blocks.append(_batch(found["batch"]))
    blocks.append(_targets(found["targets"]))
    return "\n\n".join(blocks)


def _machine(machine: dict[str, str]) -> str:
    head = f"{machine['processor']}, {machine['cores']} cores, {machine['system']}, {machine['python']}"
    rest = ", ".join(f"{name} {number}" for name, number in list(machine.items())[4:])
    return f"{head}\n{rest}"


def _table(title: str, rows: dict[str, Any]) -> str:
    head = f"{title:<66}" + "".join(f"{name:>9}" for name in COLUMNS) + "   mean's quartiles"
    lines = [head]
    for name, row in rows.items():
        low, high = row["spread"]["mean"]
        cells = "".join(f"{row[column]:>9.3g}" for column in COLUMNS)
        lines.append(f"  {name:<64}{cells}   {low:.3g} to {high:.3g}")
    return "\n".join(lines)


def _parts(found: dict[str, Any]) -> str:
    parts = found["qp_parts_us"]
    return (
        f"Whole step of the QP with daqp-direct, mean {parts['whole']:.3g} us: model {parts['model']:.3g} "
        f"(kinematics, P, q),\n  daqp's C core {parts['core']:.3g} (as it reports itself), "
        f"allocation and call {parts['allocation_and_call']:.3g}.\n"
        "  The QP holds the robot's speed limits in its bounds; our step leaves them to the loop (see `in the loop`)."
    )


def _ratios(found: dict[str, Any]) -> str:
    names = ("mean", "max", "min", "p999", "worst")
    lines = [f"{'Times faster':<66}" + "".join(f"{name:>9}" for name in names) + "   mean's quartiles"]
    shown = {"default_qp": "plain step against qpsolvers + quadprog"}
    if "fastest_qp" in found["ratios"]:
        shown = {"fastest_qp": f"compiled step against the fastest QP ({found['fastest_qp']})"} | shown
    reported = "".join(f"{PAPER[name]:>9.3g}" for name in names if name in PAPER)
    lines.append(f"  {'the paper, of its law against its QP (reported, not measured here)':<64}{reported}")
    for key, label in shown.items():
        row = found["ratios"][key]
        low, high = row["spread"]["mean"]
        cells = "".join(f"{row[name]:>9.3g}" for name in names)
        lines.append(f"  {label:<64}{cells}   {low:.3g} to {high:.3g}")
    lines.append(
        f"  Medians over {found['rounds']} rounds of {found['samples']} calls each, in turns; "
        "worst: the longest single call of all rounds."
    )
    return "\n".join(lines)


def _batch(batch: dict[str, Any]) -> str:
    low, high = batch["spread"]
    lines = [
        f"Batch of {batch['robots']:,} robots, float64: {batch['steps_per_s'] / 1e6:.3g} million control steps/s "
        f"[{low / 1e6:.3g} to {high / 1e6:.3g}] on {batch['threads']} threads,\n  {batch['times_numpy']:.3g} times "
        f"numpy's {batch['numpy_steps_per_s'] / 1e6:.3g}; with the tanh blend {batch['tanh_steps_per_s'] / 1e6:.3g}",
        "  threads        " + "".join(f"{n:>12}" for n in batch["by_threads"]),
        "  million/s      " + "".join(f"{value / 1e6:>12.3g}" for value in batch["by_threads"].values()),
        "  robots         " + "".join(f"{int(n):>12,}" for n in batch["by_size"]),
        "  million/s      " + "".join(f"{row['compiled'] / 1e6:>12.3g}" for row in batch["by_size"].values()),
        "  numpy          " + "".join(f"{row['numpy'] / 1e6:>12.3g}" for row in batch["by_size"].values()),
        f"  memory grew by {batch['memory_mb']['grown_over_all_rounds']:.3g} MB over all rounds "
        f"(arrays in and out: {batch['memory_mb']['arrays']:.3g} MB)",
    ]
    return "\n".join(lines)


def _targets(targets: list[dict[str, Any]]) -> str:
    lines = ["What this project set out to reach"]
    for one in targets:
        mark = "reached" if one["reached"] else "MISSED "
        part = one["value"] / one["target"]
        lines.append(f"  {mark}  {one['name']:<76}{one['value']:>10.4g}  of {one['target']:<8.4g}{part:>5.0%}")
    return "\n".join(lines)
