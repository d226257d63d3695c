"""The paper's optimisation baseline: a quadratic program over base and joint rates, at every step."""

from __future__ import annotations

import math
from typing import Any, final

from overreach.arm.planar import L_LEAST, forward, inverse, jacobian
from overreach.baselines.common import NO_SOLUTION, shared
from overreach.baselines.settings import check_settings
from overreach.baselines.solver import SOLVERS, Array, solver
from overreach.errors import SetupError
from overreach.extras import require
from overreach.law.blend import step
from overreach.law.workspace import Mount, Workspace
from overreach.model.planar import PlanarRobot
from overreach.types import Frame, Split

DAMPING = 0.01
"""lambda. The paper gives 0 < lambda < 1; the value is ours."""


@final
class PaperQP:
    """min 1/2 |J q - v_ref|^2 + lambda/2 |q|^2, |q_i| <= q_max,i; see `qp`.

    q = (v_b, w_b, dtheta_1, dtheta_2), v_ref = (v_c, w_c), J of the paper's model (3):
    J = [[cos psi_d, 0, 0, j_l], [0, 1, 1, j_psi]]. Source: Kwon et al. 2026, section 5.
    """

    name = "qp"
    frame = Frame.POLAR
    closes_residual = False

    def __init__(
        self,
        workspace: Workspace,
        mount: Mount,
        robot: PlanarRobot,
        solver_name: str,
        damping: float,
        **settings: float,
    ) -> None:
        if not (math.isfinite(damping) and damping > 0.0):
            raise SetupError(f"damping must be a finite number > 0, got {damping:g}")
        numpy: Any = require("numpy", "qp", "the law qp")
        self.workspace = workspace
        self.blend = step()
        self.mount = mount
        self.solver = solver_name
        if solver_name in SOLVERS:
            check_settings(solver_name, settings, also=("solver", "damping"))
        self._solve = solver(solver_name, **settings)
        self._arm = robot.arm
        base = robot.base
        self.q_max: Array = numpy.array((base.v_max, base.w_max, *robot.arm.dtheta_max))
        self._least = -self.q_max
        self._damping = damping
        self._P: Array = numpy.eye(4) * (1.0 + damping)
        self._P[1, 2] = self._P[2, 1] = 1.0
        self._q: Array = numpy.zeros(4)

    def problem(self, psi: float, j_l: float, j_psi: float, v_c: float, w_c: float) -> tuple[Array, Array]:
        """Return (P, q) of min 1/2 x^T P x + q^T x: P = J^T J + lambda I, q = -J^T v_ref, written out.

        The two arrays are this law's own, written anew at every call: copy what is to be kept.
        """
        P, q = self._P, self._q
        c = math.cos(psi + self.mount.yaw)
        P[0, 0] = c * c + self._damping
        P[0, 3] = P[3, 0] = c * j_l
        P[1, 3] = P[2, 3] = P[3, 1] = P[3, 2] = j_psi
        P[3, 3] = j_l * j_l + j_psi * j_psi + self._damping
        q[0] = -c * v_c
        q[1] = q[2] = -w_c
        q[3] = -j_l * v_c - j_psi * w_c
        return P, q

    def solve(self, P: Array, q: Array) -> Array | None:
        """Return the rates for a problem, or None: the solver's core alone."""
        return self._solve(P, q, self._least, self.q_max)

    def model(self, theta_1: float, theta_2: float, v_c: float, w_c: float) -> tuple[Array, Array]:
        """Return `problem` for joints [rad] and a command: forward kinematics, Jacobian, P and q."""
        a, b = self._arm.links
        f = b * math.sin(theta_2)
        e = a + b * math.cos(theta_2)
        l_2 = e * e + f * f
        psi = theta_1 + math.atan2(f, e)
        return self.problem(psi, -a * f / math.sqrt(l_2), (l_2 - a * e) / l_2, v_c, w_c)

    def step(self, theta_1: float, theta_2: float, v_c: float, w_c: float) -> Array | None:
        """Return (v_b, w_b, dtheta_1, dtheta_2) for joints [rad] and a command: the whole step."""
        return self.solve(*self.model(theta_1, theta_2, v_c, w_c))

    def split(self, l: float, psi: float, u_r: float, u_t: float) -> Split:
        """Return `split_joints` for the joints that put the hand at (l [m], psi [rad])."""
        return self.split_joints(inverse(l, psi, *self._arm.links, self._arm.elbow), u_r, u_t)

    def split_joints(self, theta: tuple[float, ...], u_r: float, u_t: float) -> Split:
        """Return the solution as a split, with v_c = u_r and w_c = u_t/l; zero and NO_SOLUTION where there is none."""
        if not math.isfinite(u_r + u_t):
            return NO_SOLUTION
        a, b = self._arm.links
        l, psi = forward(theta[0], theta[1], a, b)
        j_l, j_psi = jacobian(theta[1], a, b)
        found = self.solve(*self.problem(psi, j_l, j_psi, u_r, u_t / max(l, L_LEAST)))
        if found is None:
            return NO_SOLUTION
        v_b, w_b, dtheta_1, dtheta_2 = found.tolist()
        if not math.isfinite(v_b + w_b + dtheta_1 + dtheta_2):
            return NO_SOLUTION
        return shared(psi, self.mount, u_r, v_b, w_b, (dtheta_1, dtheta_2), j_l, j_psi)


def qp(
    workspace: Workspace | None = None,
    mount: Mount | None = None,
    robot: PlanarRobot | None = None,
    solver: str = "daqp",
    damping: float = DAMPING,
    **settings: float,
) -> PaperQP:
    """Baseline: the paper's quadratic program in its model (3), damped, with the speed limits of base and joints.

    `settings` go to the solver. Raises SetupError for one it does not have or cannot use, MissingExtraError without the
    extra `qp`.
    """
    return PaperQP(workspace or Workspace(), mount or Mount(), robot or PlanarRobot(), solver, damping, **settings)
