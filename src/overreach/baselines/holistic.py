"""Holistic reactive control, for a planar robot: one quadratic program with slack, dampers and two side goals.

Source: Haviland, Suenderhauf, Corke, "A Holistic Approach to Reactive Mobile Manipulation", RA-L 7(2), 2022.
"""

from __future__ import annotations

import math
from typing import Any, final

from overreach.arm.planar import forward, inverse, jacobian
from overreach.baselines.common import NO_SOLUTION, shared
from overreach.baselines.solver import Array, solver
from overreach.extras import require
from overreach.law.blend import step
from overreach.law.workspace import Mount, Workspace
from overreach.model.planar import PlanarRobot
from overreach.types import Frame, Split

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


@final
class Holistic:
    """x = (v_b, w_b, dtheta_1, dtheta_2, delta_r, delta_t), true kinematics; see `holistic`.

    min 1/2 x^T Q x + C^T x   subject to   [J I] x = u,   joint velocity dampers,   |x_i| <= x_max,i
    Q = diag(0.01/e, 0.01/e, 0.01, 0.01, 1/e, 1/e),   C = (0, -k psi_d, 0, -dm/dtheta_2, 0, 0),   m = a b |sin theta_2|
    """

    name = "holistic"
    frame = Frame.HAND
    closes_residual = False

    def __init__(self, workspace: Workspace, mount: Mount, robot: PlanarRobot, solver_name: str) -> None:
        numpy: Any = require("numpy", "qp", "the law holistic")
        self.workspace = workspace
        self.blend = step()
        self.mount = mount
        self.solver = solver_name
        self._numpy = numpy
        self._solve = solver(solver_name)
        self._arm = arm = robot.arm
        self._ub: Array = numpy.array((robot.base.v_max, robot.base.w_max, *arm.dtheta_max, SLACK_MAX, SLACK_MAX))
        self._lb: Array = -self._ub
        # The elbow is to keep its side: theta_2 ends where the arm is straight or folded.
        inner = (0.0, arm.theta_max[1]) if arm.elbow > 0 else (arm.theta_min[1], 0.0)
        self._ends = ((arm.theta_min[0], arm.theta_max[0]), inner)

    def problem(
        self, l: float, psi: float, theta: tuple[float, ...], j_l: float, j_psi: float, u_r: float, u_t: float
    ) -> tuple[Array, ...]:
        """Return (Q, C, lb, ub, A, b); the dampers stand in the bounds of the joint rates."""
        numpy, mount = self._numpy, self.mount
        a, b = self._arm.links
        psi_d = psi + mount.yaw
        c, sn = math.cos(psi_d), math.sin(psi_d)
        dear = 1.0 / (LOOK_AHEAD_S * math.hypot(u_r, u_t))
        Q = numpy.diag((RATE_COST * dear, RATE_COST * dear, RATE_COST, RATE_COST, dear, dear))
        rise = a * b * math.cos(theta[1]) * math.copysign(1.0, math.sin(theta[1]))
        C = numpy.array((0.0, -HEADING_GAIN * _facing(l, psi_d, mount), 0.0, -rise, 0.0, 0.0))
        A = numpy.array(
            (
                (c, mount.s_x * sn - mount.s_y * c, 0.0, j_l, 1.0, 0.0),
                (-sn, l + mount.s_x * c + mount.s_y * sn, l, l * j_psi, 0.0, 1.0),
            )
        )
        lb, ub = self._lb.copy(), self._ub.copy()
        for k, (angle, (least, most)) in enumerate(zip(theta, self._ends, strict=True), start=2):
            ub[k] = min(ub[k], damper(most - angle))
            lb[k] = max(lb[k], -damper(angle - least))
            if lb[k] > ub[k]:  # both ends at once cannot be: hold the joint
                lb[k] = ub[k] = 0.0
        return Q, C, lb, ub, A, numpy.array((u_r, u_t))

    def split(self, l: float, psi: float, u_r: float, u_t: float) -> Split:
        """Return `split_joints` for the joints that put the hand at (l [m], psi [rad])."""
        return self.split_joints(inverse(l, psi, *self._arm.links, self._arm.elbow), u_r, u_t)

    def split_joints(self, theta: tuple[float, ...], u_r: float, u_t: float) -> Split:
        """Return the solution as a split; zero and NO_SOLUTION where there is none."""
        if abs(u_r) < STILL and abs(u_t) < STILL:
            return Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        if not math.isfinite(u_r + u_t):
            return NO_SOLUTION
        a, b = self._arm.links
        l, psi = forward(theta[0], theta[1], a, b)
        j_l, j_psi = jacobian(theta[1], a, b)
        Q, C, lb, ub, A, rhs = self.problem(l, psi, theta, j_l, j_psi, u_r, u_t)
        found = self._solve(Q, C, lb, ub, A=A, b=rhs)
        if found is None:
            return NO_SOLUTION
        v_b, w_b, dtheta_1, dtheta_2, _, _ = found.tolist()
        if not math.isfinite(v_b + w_b + dtheta_1 + dtheta_2):
            return NO_SOLUTION
        return shared(psi, self.mount, u_r, v_b, w_b, (dtheta_1, dtheta_2), j_l, j_psi)


def damper(room: float) -> float:
    """Return the greatest rate [rad/s] towards a joint limit that is `room` [rad] away.

    eta (room - rho_s)/(rho_i - rho_s) within rho_i of it (negative within rho_s: it backs out), unlimited farther off.
    """
    if room > DAMPER_START:
        return math.inf
    return DAMPER_GAIN * (room - DAMPER_STOP) / (DAMPER_START - DAMPER_STOP)


def _facing(l: float, psi_d: float, mount: Mount) -> float:
    """Return the bearing [rad] of the hand from the base's centre."""
    return math.atan2(mount.s_y + l * math.sin(psi_d), mount.s_x + l * math.cos(psi_d))


def holistic(
    workspace: Workspace | None = None,
    mount: Mount | None = None,
    robot: PlanarRobot | None = None,
    solver: str = "daqp",
) -> Holistic:
    """Baseline: Haviland et al. 2022, a quadratic program with slack, manipulability, joint dampers and base heading.

    Raises MissingExtraError without the extra `qp`.
    """
    return Holistic(workspace or Workspace(), mount or Mount(), robot or PlanarRobot(), solver)
