"""`overreach bench`: measure everything, compare it with what is to be reached, say both."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from overreach.baselines.solver import DIRECT
from overreach.bench import steps
from overreach.bench.machine import describe
from overreach.bench.measure import Candidate, Timed, in_turns, ratio
from overreach.extras import require
from overreach.types import Record

PAPER = {"mean": 35.4, "max": 20.7, "min": 37.5}
"""How many times faster than a QP the paper reports its law to be."""
BATCH_TARGET = 4e7
ROUNDS = 20


class Target(Record, frozen=True):
    """What is to be reached, and what was."""

    name: str
    target: float
    value: float

    @property
    def reached(self) -> bool:
        """Whether the value is at least the target."""
        return self.value >= self.target


def time_steps(rounds: int, samples: int = 1_000, tell: Callable[[int], object] = lambda done: None) -> dict[str, Any]:
    """Return what laws and whole steps take for one robot, and the ratios. Compiled only where numba is installed."""
    rows = steps.stream(min(samples, steps.DISTINCT))
    fast = _has("numba")
    laws, whole, parts = steps.laws(rows, fast), steps.steps(rows, fast), steps.parts_of_qp(rows)
    took = in_turns(steps.repeated([*laws, *whole, *parts], samples), rounds, tell)
    qps = {one.name: took[one.name] for one in whole if one.name.startswith("step qp")}
    fastest = min(qps, key=lambda name: qps[name].of("mean").median)
    model, call = (took[one.name].of("mean").median for one in parts)
    core = steps.core_of_daqp(rows)
    found: dict[str, Any] = {
        "samples": samples,
        "rounds": rounds,
        "law_us": _named(laws, took, "law "),
        "step_us": {"plain": took[steps.PLAIN].as_dict()},
        "steps_us": _named(whole, took, "step "),
        "fastest_qp": fastest.removeprefix("step qp, "),
        "qp_parts_us": {
            "model": model,
            "core": core,
            "allocation_and_call": call - core,
            "whole": took[f"step qp, {DIRECT}"].of("mean").median,
        },
        "ratios": {"default_qp": _ratios(took[steps.DEFAULT_QP], took[steps.PLAIN])},
    }
    if fast:
        found["step_us"]["compiled"] = took[steps.COMPILED].as_dict()
        found["ratios"]["fastest_qp"] = _ratios(qps[fastest], took[steps.COMPILED])
    return found


def _named(candidates: list[Candidate], took: dict[str, Timed], prefix: str) -> dict[str, Any]:
    return {one.name.removeprefix(prefix): took[one.name].as_dict() for one in candidates}


def _ratios(slow: Timed, fast: Timed) -> dict[str, Any]:
    """Return the ratios of every statistic, their quartiles, and that of the two longest calls of all."""
    found = {name: ratio(slow, fast, name) for name in ("mean", "max", "min", "p50", "p99", "p999", "stamped_mean")}
    return {
        **{name: value.median for name, value in found.items()},
        "worst": slow.worst / fast.worst,
        "spread": {name: [value.low, value.high] for name, value in found.items()},
    }


def _has(module: str) -> bool:
    from importlib.util import find_spec

    return find_spec(module) is not None


def targets(found: dict[str, Any]) -> list[Target]:
    """Return what was to be reached beside what was."""
    reached = []
    fastest = found["ratios"].get("fastest_qp")
    if fastest:
        name = f"compiled step against the fastest QP's whole step ({found['fastest_qp']})"
        reached = [Target(f"{name}, {key}", PAPER[key], fastest[key]) for key in PAPER]
    default = found["ratios"]["default_qp"]["mean"]
    reached.append(Target("plain step against qpsolvers + quadprog, mean", PAPER["mean"], default))
    if "batch" in found:
        value = found["batch"]["steps_per_s"]
        reached.append(Target("batch, control steps per second", BATCH_TARGET, value))
    return reached


def measure(rounds: int = ROUNDS, progress: bool = True) -> dict[str, Any]:
    """Return all that `overreach bench --json` writes. Raises MissingExtraError without the extras fast and qp."""
    require("numba", "fast,qp", "bench")
    require("qpsolvers", "fast,qp", "bench")
    bar = require("tqdm", "fast,qp", "bench").tqdm(
        total=rounds + 3, disable=None if progress else True, leave=False, unit="round", desc="one robot"
    )
    from overreach.bench import batch

    def further(what: str) -> None:
        bar.set_description(what)
        bar.update(1)

    with bar:
        found = {"machine": describe(), **time_steps(rounds, tell=lambda done: bar.update(1))}
        found["batch"] = batch.measure(tell=further)
    found["targets"] = [
        {"name": one.name, "target": one.target, "value": one.value, "reached": one.reached} for one in targets(found)
    ]
    return found
