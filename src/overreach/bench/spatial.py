"""`overreach bench --robot R`: what a control step costs for an arm in space, beside mink with daqp, in turns.

step      what one decision computes: forward kinematics, the law, rates within every limit, the correction and the
          check by forward kinematics; at states that the loop has met
tick      the pilot's whole tick around it: gate, feedback, frame, guard, records
mink      a QP on the same model, by mink's own solve_ik with daqp, its configuration updated: see `peers`
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from overreach.arm.spatial.engine import warm
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.step import DONE
from overreach.bench.machine import describe
from overreach.bench.measure import Candidate, Spread, in_turns, ratio, spread
from overreach.bench.peers import Peer, peers
from overreach.check.driven import commanded, drive
from overreach.check.streams import stream
from overreach.clock import nanoseconds
from overreach.control.pilot import Pilot
from overreach.control.tick import Tick
from overreach.errors import SetupError
from overreach.extras import require
from overreach.law.laws import Exact, usual_blend
from overreach.model.catalogue import parts_for
from overreach.model.described import DescribedRobot
from overreach.plugs import load_model

SEED = 1
DISTINCT = 250
"""Different states in a round."""
ROUNDS = 25
COMPILED, LEAN, TICK = "step, compiled", "step, numpy", "whole Pilot.tick, compiled"
AT_MOST = {COMPILED: 5.0, LEAN: 40.0, TICK: 60.0}
"""What is to be reached [us] ..."""
TIMES = {COMPILED: 20.0, LEAN: 2.5}
"""... and how many times faster than the faster of mink's two."""


class Met(NamedTuple):
    """What one step of the loop was given: joints, and what was asked; see `arm.spatial.step`."""

    q: Array
    asked: Array
    l: float
    psi: float
    u: tuple[float, float]


class _Listening:
    """An engine that keeps what it is given."""

    def __init__(self, engine: Any) -> None:
        self._engine, self.forward = engine, engine.forward
        self.met: list[Met] = []

    def step(self, q: Array, hand: Array, J: Array, asked: Array, out: Array) -> None:
        x, y = hand[9:11].tolist()
        l, psi = float(np.hypot(x, y)), float(np.arctan2(y, x))
        c, s = np.cos(psi), np.sin(psi)
        u = float(c * asked[0] + s * asked[1]), float(c * asked[1] - s * asked[0])
        self.met.append(Met(q.copy(), asked.copy(), l, psi, u))
        self._engine.step(q, hand, J, asked, out)


def with_engine(model: DescribedRobot, compiled: bool) -> DescribedRobot:
    """Return the robot with its arm's step compiled, or with numpy."""
    arm = model.arm
    made = arm.made(arm.home, arm.manner, compiled)
    return DescribedRobot(
        model.name, model.summary, made, model.mount, model.base, model.workspace, model.command, model.gripper,
        model.mode,
    )  # fmt: skip


def met_by(model: DescribedRobot) -> list[Met]:
    """Return steps of a smooth stream, evenly: the arm alone, blending and the base all occur."""
    listening = _Listening(model.arm.engine)
    model.arm.engine = listening
    drive(model, stream("smooth", SEED, 0, model.command))
    model.arm.engine = listening._engine
    return listening.met[100 :: max(1, len(listening.met) // DISTINCT)][:DISTINCT]


def step_of(model: DescribedRobot) -> Callable[[Met], None]:
    """Return what one decision computes."""
    engine, n = model.arm.engine, len(model.arm.channels)
    share = Exact(usual_blend(Exact().blend, model)).bind(model)
    hand, J, places, out = np.empty(12), np.empty((6, n)), np.empty((n, 3)), np.empty(n + DONE)

    def step(met: Met) -> None:
        engine.forward(met.q, hand, J, places)
        share(met.l, met.psi, *met.u)
        engine.step(met.q, hand, J, met.asked, out)

    return step


def tick_of(model: DescribedRobot, rounds: int) -> list[float]:
    """Return the mean time [us] of a pilot's tick in each round: one stream, replayed by a new pilot each time."""
    law = Exact(usual_blend(Exact().blend, model))
    inputs: list[Tick] = commanded(model, stream("smooth", SEED, 0, model.command)[:600])
    found = []
    for _ in range(rounds):
        pilot = Pilot(model, law)
        for request in inputs[0].requests:
            pilot.ask(request, 0.0)  # type: ignore[arg-type]  # the one that arms
        for one in inputs[:50]:
            pilot.tick(one.state, one.command, one.now, one.dt)
        begun = nanoseconds()
        for one in inputs[50:]:
            pilot.tick(one.state, one.command, one.now, one.dt)
        found.append((nanoseconds() - begun) / len(inputs[50:]) / 1000.0)
    return found


def measure(robot: str, rounds: int = ROUNDS, tell: Callable[[int], object] = lambda done: None) -> dict[str, Any]:
    """Return what a step costs for `robot`, beside its peers. Raises SetupError for a robot that moves in the plane."""
    require("mink", "peers,fast", "bench --robot")
    require("numba", "peers,fast", "bench --robot")
    warm()
    model = load_model(robot)
    if not isinstance(model, DescribedRobot):
        raise SetupError(f"{robot!r} moves in the plane: `overreach bench` is for it")
    parts = parts_for(robot)
    fast, lean = with_engine(model, True), with_engine(model, False)
    met = met_by(fast)
    given = [(one,) for one in met]
    rivals: list[Peer] = peers(parts)
    candidates = [Candidate(COMPILED, step_of(fast), given), Candidate(LEAN, step_of(lean), given)]
    candidates += [Candidate(one.name, one.solve, [(each.q, each.asked[:3]) for each in met[::5]]) for one in rivals]
    took = in_turns(candidates, rounds, tell)
    ticks = spread(tick_of(fast, max(3, rounds // 3)))
    means = {one.name: took[one.name].of("mean") for one in candidates} | {TICK: ticks}
    faster = min((one.name for one in rivals), key=lambda rival: means[rival].median)
    times = {one: ratio(took[faster], took[one], "mean") for one in (COMPILED, LEAN)}
    return {
        "machine": describe(),
        "robot": model.name,
        "mode": model.mode,
        "rounds": rounds,
        "step_us": {one: _told(value) for one, value in means.items()},
        "faster_peer": faster,
        "times_faster": {one: _told(value) for one, value in times.items()},
        "targets": [
            *[{"name": one, "at_most": most, "value": means[one].median} for one, most in AT_MOST.items()],
            *[{"name": one, "times": least, "value": times[one].median} for one, least in TIMES.items()],
        ],
    }


def _told(value: Spread) -> dict[str, float]:
    return {"median": value.median, "low": value.low, "high": value.high}


def text(found: dict[str, Any]) -> str:
    """Return the report."""
    lines = [f"{found['robot']}, {found['mode']}: one control step [us], median of {found['rounds']} rounds"]
    for name, one in found["step_us"].items():
        lines.append(f"  {name:<34}{one['median']:>9.3g}   {one['low']:.3g} to {one['high']:.3g}")
    lines.append(f"Times faster than {found['faster_peer']}")
    for name, one in found["times_faster"].items():
        lines.append(f"  {name:<34}{one['median']:>9.3g}   {one['low']:.3g} to {one['high']:.3g}")
    lines.append("What this project set out to reach")
    for one in found["targets"]:
        if "at_most" in one:
            mark, bound = "reached" if one["value"] <= one["at_most"] else "MISSED ", f"at most {one['at_most']:g} us"
        else:
            mark, bound = "reached" if one["value"] >= one["times"] else "MISSED ", f"at least {one['times']:g} times"
        lines.append(f"  {mark}  {one['name']:<30}{one['value']:>9.3g}   {bound}")
    return "\n".join(lines)
