"""The paper's optimisation baseline: a quadratic program over base and joint rates, at every step."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import reduce
from operator import sub
from typing import Annotated, Any, final

from overreach.arm.chain import Chain
from overreach.arm.mount import Mount
from overreach.baselines.common import UNSOLVED, base_rows, planned
from overreach.baselines.settings import check_settings
from overreach.baselines.solver import SOLVERS, Array, solver
from overreach.extras import require
from overreach.law.body import Planner, WholeBody
from overreach.model.model import Model
from overreach.parameters import choice, number
from overreach.types import Frame, HandTwist, Plan, Twist

L_LEAST = 1e-6
"""Shortest length [m] that is divided by."""


class PaperQP(WholeBody, frozen=True):
    """Baseline: the paper's quadratic program in its model (3), damped, with the speed limits of base and joints.

    min 1/2 |J q - v_ref|^2 + lambda/2 |q|^2, |q_i| <= q_max,i, with q = (v_b, w_b, joints), v_ref = (v_c, w_c), and
    J of the paper's model (3): the base's columns (cos psi_d, 0), (0, 1), the arm's its polar Jacobian; an arm with
    more rows brings those along. damping: lambda (the paper gives 0 < lambda < 1; the value is ours); settings: of the
    solver.
    Raises SetupError for a setting it does not have or cannot use, MissingExtraError without the extra `qp`.
    Source: Kwon et al. 2026, section 5.
    """

    name = "qp"
    frame = Frame.POLAR
    closes_residual = False
    slow_to_load = True
    solver: Annotated[str, choice("QP solver", SOLVERS)] = "daqp"
    damping: Annotated[float, number("λ  damping", "", 0.001, 1.0, 0.001, above=0.0)] = 0.01
    settings: Mapping[str, Any] = {}

    def __post_init__(self) -> None:
        super().__post_init__()
        require("numpy", "qp", "the law qp")
        check_settings(self.solver, self.settings)

    def planner(self, model: Model) -> Planner:
        """Return the solution as a plan, v_c = u_r and w_c = u_t/l; nothing and NO_SOLUTION where there is none."""
        return Program(self, model).plan


@final
class Program:
    """The quadratic program of `PaperQP` for one robot."""

    def __init__(self, plug: PaperQP, model: Model) -> None:
        numpy: Any = require("numpy", "qp", "the law qp")
        channels = (*model.base.channels, *model.arm.channels)
        n = len(channels)
        self._mount: Mount = model.mount
        self._rows = model.arm.rows
        self._solve = solver(plug.solver, **plug.settings)
        self.q_max: Array = numpy.array([channel.rate_max for channel in channels])
        self._least = -self.q_max
        self._damping = plug.damping
        self._P: Array = numpy.eye(n) * (1.0 + plug.damping)
        self._q: Array = numpy.zeros(n)

    def problem(self, chain: Chain, v_c: float, w_c: float, u: HandTwist) -> tuple[Array, Array]:
        """Return (P, q) of min 1/2 x^T P x + q^T x: P = J^T J + lambda I, q = -J^T v_ref, written out.

        The two arrays are this program's own, written anew at every call: copy what is to be kept.
        """
        P, q, damping = self._P, self._q, self._damping
        c = math.cos(chain.psi + self._mount.yaw)
        arm = chain.jacobian()
        rows = [(arm[k], wanted) for k, wanted in _wanted(v_c, w_c, u) if k in self._rows]
        P[0, 0] = c * c + damping
        q[0] = -c * v_c
        q[1] = -w_c
        joints = range(len(arm[0]))
        for i in joints:
            P[0, i + 2] = P[i + 2, 0] = c * arm[0][i]
            P[1, i + 2] = P[i + 2, 1] = arm[1][i]
            for j in joints[i:]:
                P[i + 2, j + 2] = P[j + 2, i + 2] = sum([row[i] * row[j] for row, _ in rows])
            P[i + 2, i + 2] += damping
            q[i + 2] = reduce(sub, [row[i] * wanted for row, wanted in rows], -0.0)  # -0.0 - x is -x
        return P, q

    def solve(self, P: Array, q: Array) -> Array | None:
        """Return the rates for a problem, or None: the solver's core alone."""
        return self._solve(P, q, self._least, self.q_max)

    def plan(self, chain: Chain, u: HandTwist, _base: Twist) -> Plan:
        """Return the solution; see `PaperQP.planner`."""
        if not math.isfinite(u.u_r + u.u_t):
            return UNSOLVED
        found = self.solve(*self.problem(chain, u.u_r, u.u_t / max(chain.l, L_LEAST), u))
        if found is None or not math.isfinite(sum(rates := found.tolist())):
            return UNSOLVED
        return planned(rates, chain, base_rows(chain, self._mount), u.u_r)


def _wanted(v_c: float, w_c: float, u: HandTwist) -> tuple[tuple[int, float], ...]:
    return (0, v_c), (1, w_c), (2, u.u_z), (3, u.w_r), (4, u.w_t), (5, u.w_z)
