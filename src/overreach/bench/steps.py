"""What is timed for one robot: the law and the whole step, plain and compiled, beside the quadratic programs."""

from __future__ import annotations

import math
from typing import Any

from overreach.arm.planar import jacobian
from overreach.arm.step import planar_step, polar_step
from overreach.baselines.holistic import holistic
from overreach.baselines.qp import PaperQP, qp
from overreach.baselines.separate import separate
from overreach.baselines.settings import SPARSE
from overreach.baselines.solver import DIRECT, SOLVERS
from overreach.baselines.weighted import weighted
from overreach.bench.measure import Candidate
from overreach.bench.replay import Replay
from overreach.law.authority import exact, paper
from overreach.law.blend import smoothstep, tanh
from overreach.law.frame import hand
from overreach.law.laws import constants
from overreach.law.laws import exact as exact_law
from overreach.law.workspace import Mount, Workspace
from overreach.model.planar import PlanarRobot
from overreach.run.simulate import Row, simulate

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
    rows = [row for row in simulate("mixed", exact_law(blend=smoothstep())).rows if row.v_c or row.w_c]
    return rows[:: max(1, len(rows) // samples)][:samples]


def repeated(candidates: list[Candidate], samples: int) -> list[Candidate]:
    """Return the candidates with their arguments gone through until there are `samples` calls in a round."""
    for one in candidates:
        one.arguments = (list(one.arguments) * -(-samples // len(one.arguments)))[:samples]
    return candidates


def _polar(row: Row) -> tuple[float, float, float, float]:
    """Return (l, psi, u_r, u_t) of a row, the command meant in the frame `hand`."""
    return row.l, row.psi, *hand(row.v_c, row.w_c, row.l, row.psi, row.theta_b, row.theta_e)


def laws(rows: list[Row], fast: bool) -> list[Candidate]:
    """Return the sharing laws alone: (l, psi, u_r, u_t) -> shares, plain and (with numba) compiled."""
    soft, steep = smoothstep(), tanh()
    polar = [_polar(row) for row in rows]
    plain = []
    for name, share, blend in (("exact", exact, soft), ("paper", paper, steep)):
        more = (blend.rise, *constants(Workspace(), blend, Mount()))
        plain.append(Candidate(f"law {name}, plain", share, [(*one, *more) for one in polar]))
    others: list[Any] = [separate(), weighted(), qp(solver=DIRECT), holistic(solver=DIRECT)]
    plain += [Candidate(f"law {law.name}, plain", law.split, polar) for law in others]
    if fast:
        from overreach.fast.robot import compile_law

        plain.append(Candidate("law exact, compiled", compile_law(), polar))
    return plain


def steps(rows: list[Row], fast: bool) -> list[Candidate]:
    """Return whole steps, from joint angles and command to base twist and joint rates."""
    soft, steep = smoothstep(), tanh()
    hand_states = [(row.theta_1, row.theta_2, row.theta_b, row.theta_e, row.v_c, row.w_c) for row in rows]
    robot = PlanarRobot()
    more = (soft.rise, *constants(robot.workspace, soft, robot.mount), *robot.arm.links)
    found = [Candidate(PLAIN, planar_step, [(*state, *more) for state in hand_states])]
    if fast:
        from overreach.fast.robot import compile_step, empty_call

        found.append(Candidate(COMPILED, compile_step(), hand_states))
        found.append(Candidate("step exact, compiled: empty call", empty_call(), hand_states))
    drive = Replay(exact_law(), len(rows))
    found.append(Candidate("step exact, in the loop: limits, guard, records and all", drive.step, drive.ticks))
    polar_states = [(row.theta_1, row.theta_2, row.v_c, row.w_c) for row in rows]
    his = (steep.rise, *constants(robot.workspace, steep, robot.mount), *robot.arm.links)
    found.append(Candidate("step paper, plain", polar_step, [(*state, *his) for state in polar_states]))
    found += [
        Candidate(f"step qp, {name}", qp(solver=name).step, polar_states, SLOW_EVERY if name in SPARSE else 1)
        for name in SOLVERS
    ]
    return found


def parts_of_qp(rows: list[Row], name: str = DIRECT) -> list[Candidate]:
    """Return the parts of a whole step of `qp` with daqp: the model (kinematics, P, q), and the call of the solver."""
    law: PaperQP = qp(solver=name)
    problems, models = [], []
    for row in rows:
        j_l, j_psi = jacobian(row.theta_2, *PlanarRobot().arm.links)
        P, q = law.problem(row.psi, j_l, j_psi, row.v_c, row.w_c)
        problems.append((P.copy(), q.copy()))
        models.append((row.theta_1, row.theta_2, row.v_c, row.w_c))
    return [
        Candidate("model of the QP: kinematics, P and q", law.model, models),
        Candidate("call of the solver (daqp-direct)", law.solve, problems),
    ]


def core_of_daqp(rows: list[Row]) -> float:
    """Return the mean time [us] that daqp itself reports for setting up and solving: its C core, no Python at all."""
    import daqp
    import numpy as np

    law = qp(solver=DIRECT)
    nothing, sense = np.zeros((0, 4)), np.zeros(4, dtype=np.intc)
    took = []
    for row in rows:
        j_l, j_psi = jacobian(row.theta_2, *PlanarRobot().arm.links)
        P, q = law.problem(row.psi, j_l, j_psi, row.v_c, row.w_c)
        *_, told = daqp.solve(P, q, nothing, law.q_max, -law.q_max, sense)
        took.append(told["setup_time"] + told["solve_time"])
    return math.fsum(took) / len(took) * 1e6
