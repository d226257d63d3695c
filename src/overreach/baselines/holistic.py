"""Holistic reactive control: one quadratic program with slack, dampers and two side goals.

Source: Haviland, Suenderhauf, Corke, "A Holistic Approach to Reactive Mobile Manipulation", RA-L 7(2), 2022.
"""

from __future__ import annotations

import math
from typing import Annotated, final

from overreach.arm.chain import Chain
from overreach.baselines.common import UNSOLVED, base_rows, commanded, planned
from overreach.baselines.solver import SOLVERS, Array, solver
from overreach.extras import require
from overreach.law.body import Planner, WholeBody
from overreach.model.model import Model
from overreach.parameters import choice
from overreach.types import HandTwist, Plan, Split, Twist

RATE_COST = 0.01
"""Cost of rates, as in the authors' published example: this for a joint, this over e for the base."""
SLACK_MAX = 10.0
"""Greatest slack [m/s], as in the publication."""
HEADING_GAIN = 0.5
"""Gain k_epsilon of the term that turns the base to face the hand."""
DAMPER_GAIN = 1.0
DAMPER_STOP = 0.1
DAMPER_START = 0.9
"""Velocity damper of the joint limits: eta, rho_s [rad] and rho_i [rad]."""
LOOK_AHEAD_S = 1.0 / 1.5
"""e = |u| times this: a stick has no goal to be e away from, but the authors servo to theirs with |u| = 1.5 e."""
STILL = 1e-9
"""A command below this [m/s] is none: e = 0, where the weights 1/e hold everything still."""


class Holistic(WholeBody, frozen=True):
    """Baseline: Haviland et al. 2022, a quadratic program with slack, manipulability, joint dampers and base heading.

    x = (v_b, w_b, joints, delta), true kinematics, one slack delta for each row that the arm has:
    min 1/2 x^T Q x + C^T x   subject to   [J I] x = u,   joint velocity dampers,   |x_i| <= x_max,i
    Q = diag(0.01/e, 0.01/e, 0.01, ..., 1/e, ...),   C = (0, -k psi_hand, -dm/dq, 0, ...),   m the arm's manipulability.
    Raises MissingExtraError without the extra `qp`.
    """

    name = "holistic"
    closes_residual = False
    slow_to_load = True
    solver: Annotated[str, choice("QP solver", SOLVERS)] = "daqp"

    def __post_init__(self) -> None:
        super().__post_init__()
        require("numpy", "qp", "the law holistic")

    def planner(self, model: Model) -> Planner:
        """Return the solution as a plan; nothing and NO_SOLUTION where there is none."""
        return Program(self, model).plan


@final
class Program:
    """The quadratic program of `Holistic` for one robot."""

    def __init__(self, plug: Holistic, model: Model) -> None:
        self._numpy = numpy = require("numpy", "qp", "the law holistic")
        self._mount = model.mount
        self._rows = list(model.arm.rows)
        self._solve = solver(plug.solver)
        channels = (*model.base.channels, *model.arm.channels)
        self._joints = len(model.arm.channels)
        self._ub: Array = numpy.array([*(channel.rate_max for channel in channels), *[SLACK_MAX] * len(self._rows)])
        self._lb: Array = -self._ub
        self._ends = model.arm.branch

    def problem(self, chain: Chain, u: HandTwist) -> tuple[Array, ...]:
        """Return (Q, C, lb, ub, A, b); the dampers stand in the bounds of the joint rates."""
        numpy, rows = self._numpy, self._rows
        n, m = self._joints, len(rows)
        base, arm = base_rows(chain, self._mount), list(chain.jacobian())
        arm[1] = tuple([chain.l * slope for slope in arm[1]])  # from bearings to the tangent
        wanted = commanded(u)
        dear = 1.0 / (LOOK_AHEAD_S * math.hypot(u.u_r, u.u_t))
        Q = numpy.diag((RATE_COST * dear, RATE_COST * dear, *[RATE_COST] * n, *[dear] * m))
        facing = math.atan2(chain.hand[1], chain.hand[0])
        rises = chain.towards_manipulability()
        C = numpy.array((0.0, -HEADING_GAIN * facing, *[-rise for rise in rises], *[0.0] * m))
        A = numpy.array([(*base[k], *arm[k], *[float(i == j) for j in range(m)]) for i, k in enumerate(rows)])
        lb, ub = self._lb.copy(), self._ub.copy()
        for k, (angle, (least, most)) in enumerate(zip(chain.joints, self._ends, strict=True), start=2):
            ub[k] = min(ub[k], damper(most - angle))
            lb[k] = max(lb[k], -damper(angle - least))
            if lb[k] > ub[k]:  # both ends at once cannot be: hold the joint
                lb[k] = ub[k] = 0.0
        return Q, C, lb, ub, A, numpy.array([wanted[k] for k in rows])

    def plan(self, chain: Chain, u: HandTwist, _base: Twist) -> Plan:
        """Return the solution; see `Holistic.planner`."""
        if abs(u.u_r) < STILL and abs(u.u_t) < STILL:
            return Plan(Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
        if not math.isfinite(u.u_r + u.u_t):
            return UNSOLVED
        Q, C, lb, ub, A, rhs = self.problem(chain, u)
        found = self._solve(Q, C, lb, ub, A=A, b=rhs)
        if found is None:
            return UNSOLVED
        rates = found.tolist()[: 2 + self._joints]
        if not math.isfinite(sum(rates)):
            return UNSOLVED
        return planned(rates, chain, base_rows(chain, self._mount), u.u_r)


def damper(room: float) -> float:
    """Return the greatest rate [rad/s] towards a joint limit that is `room` [rad] away.

    eta (room - rho_s)/(rho_i - rho_s) within rho_i of it (negative within rho_s: it backs out), unlimited farther off.
    """
    if room > DAMPER_START:
        return math.inf
    return DAMPER_GAIN * (room - DAMPER_STOP) / (DAMPER_START - DAMPER_STOP)
