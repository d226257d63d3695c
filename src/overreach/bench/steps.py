"""What is timed for one robot: the law and the whole step, plain and compiled, beside the quadratic programs."""

from __future__ import annotations

import math

from overreach.baselines.holistic import Holistic
from overreach.baselines.qp import PaperQP
from overreach.baselines.separate import Separate
from overreach.baselines.settings import SPARSE
from overreach.baselines.solver import DIRECT, SOLVERS
from overreach.baselines.weighted import Weighted
from overreach.bench.measure import Candidate
from overreach.bench.planar_paper import paper_step
from overreach.bench.planar_qp import PlanarQP
from overreach.bench.replay import Replay
from overreach.fast.step import planar_step
from overreach.law.authority import exact, paper
from overreach.law.blend import Smoothstep, Tanh
from overreach.law.body import WholeBody
from overreach.law.frame import FRAMES, meant, of_two
from overreach.law.laws import Exact, constants
from overreach.model.planar import planar
from overreach.run.row import Row
from overreach.run.simulate import simulate
from overreach.types import Frame, HandTwist, Twist

SLOW_EVERY = 5
"""Solvers that take half a millisecond run in every fifth round."""

PLAIN, COMPILED = "step exact, plain", "step exact, compiled"
DEFAULT_QP = "step qp, quadprog"
"""The default way to a quadratic program from Python: qpsolvers with quadprog."""


DISTINCT = 250
"""Different states in a round, gone through again and again: few enough to stay in cache, as those of a loop do."""


def stream(samples: int = DISTINCT) -> list[Row]:
    """Return states and commands evenly from the scenario `mixed`: arm alone, blending and base alone all occur.

    Moments without a command are left out: the closed forms would be done with them at once.
    """
    rows = [row for row in simulate("mixed", Exact(blend=Smoothstep())).rows if row.v_c or row.w_c]
    return rows[:: max(1, len(rows) // samples)][:samples]


def repeated(candidates: list[Candidate], samples: int) -> list[Candidate]:
    """Return the candidates with their arguments gone through until there are `samples` calls in a round."""
    for one in candidates:
        one.arguments = (list(one.arguments) * -(-samples // len(one.arguments)))[:samples]
    return candidates


def _polar(row: Row) -> tuple[float, float, float, float]:
    """Return (l, psi, u_r, u_t) of a row, the command meant in the frame `hand`."""
    twist = of_two(Frame.HAND, row.v_c, row.w_c)
    u = meant(FRAMES[Frame.HAND], twist, row.l, row.psi, row.theta_b, row.theta_e)
    return row.l, row.psi, u.u_r, u.u_t


def laws(rows: list[Row], fast: bool) -> list[Candidate]:
    """Return the sharing laws alone: (l, psi, u_r, u_t) -> shares, plain and (with numba) compiled."""
    soft, steep = Smoothstep(), Tanh()
    polar = [_polar(row) for row in rows]
    plain = []
    for name, share, blend in (("exact", exact, soft), ("paper", paper, steep)):
        more = (blend.rise, *constants(planar(), blend))
        plain.append(Candidate(f"law {name}, plain", share, [(*one, *more) for one in polar]))
    others: list[WholeBody] = [Separate(), Weighted(), PaperQP(solver=DIRECT), Holistic(solver=DIRECT)]
    model = planar()
    plans = [
        (model.arm.at(row.theta, model.mount), HandTwist(u_r, u_t), Twist(row.v_b, w_z=row.w_b))
        for row, (_, _, u_r, u_t) in zip(rows, polar, strict=True)
    ]
    plain += [Candidate(f"law {law.name}, plain", law.planner(model), plans) for law in others]
    if fast:
        from overreach.fast.robot import compile_law

        plain.append(Candidate("law exact, compiled", compile_law(), polar))
    return plain


def steps(rows: list[Row], fast: bool) -> list[Candidate]:
    """Return whole steps, from joint angles and command to base twist and joint rates."""
    soft = Smoothstep()
    hand_states = [(*row.theta, row.theta_b, row.theta_e, row.v_c, row.w_c) for row in rows]
    robot = planar()
    more = (soft.rise, *constants(robot, soft), *robot.arm.links)
    found = [Candidate(PLAIN, planar_step, [(*state, *more) for state in hand_states])]
    if fast:
        from overreach.fast.robot import compile_step, empty_call

        found.append(Candidate(COMPILED, compile_step(), hand_states))
        found.append(Candidate("step exact, compiled: empty call", empty_call(), hand_states))
    drive = Replay(Exact(), len(rows))
    found.append(Candidate("step exact, in the loop: gate, limits, guard, record and all", drive.tick, drive.ticks))
    steep = Tanh()
    polar_states = [(*row.theta, row.v_c, row.w_c) for row in rows]
    his = (steep.rise, *constants(robot, steep), *robot.arm.links)
    found.append(Candidate("step paper, plain", paper_step, [(*state, *his) for state in polar_states]))
    found += [
        Candidate(f"step qp, {name}", PlanarQP(robot, name).step, polar_states, SLOW_EVERY if name in SPARSE else 1)
        for name in SOLVERS
    ]
    return found


def parts_of_qp(rows: list[Row], name: str = DIRECT) -> list[Candidate]:
    """Return the parts of a whole step of `qp` with daqp: the model (kinematics, P, q), and the call of the solver."""
    step = PlanarQP(planar(), name)
    states = [(*row.theta, row.v_c, row.w_c) for row in rows]
    problems = [tuple(array.copy() for array in step.model(*state)) for state in states]
    return [
        Candidate("model of the QP: kinematics, P and q", step.model, states),
        Candidate("call of the solver (daqp-direct)", step.solve, problems),
    ]


def core_of_daqp(rows: list[Row]) -> float:
    """Return the mean time [us] that daqp itself reports for setting up and solving: its C core, no Python at all."""
    import daqp
    import numpy as np

    step = PlanarQP(planar(), DIRECT)
    nothing, sense = np.zeros((0, 4)), np.zeros(4, dtype=np.intc)
    took = []
    for row in rows:
        P, q = step.model(row.theta[0], row.theta[1], row.v_c, row.w_c)
        *_, told = daqp.solve(P, q, nothing, step.q_max, -step.q_max, sense)
        took.append(told["setup_time"] + told["solve_time"])
    return math.fsum(took) / len(took) * 1e6
