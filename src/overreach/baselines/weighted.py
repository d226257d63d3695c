"""The cheap rival: a weighted minimum-norm pseudo-inverse, in closed form."""

from __future__ import annotations

import math
from math import cos, sin
from typing import final

from overreach.arm.planar import forward, inverse, jacobian
from overreach.baselines.common import NO_SOLUTION, shared
from overreach.errors import SetupError
from overreach.law.blend import step
from overreach.law.workspace import Mount, Workspace
from overreach.model.planar import PlanarRobot
from overreach.types import Frame, Split

BASE_WEIGHT = 1.0
"""How much dearer a rate of the base [m/s, rad/s] is than one of a joint [rad/s]. 1: the plain pseudo-inverse."""
NEAR = 0.01
"""Below det M = NEAR (trace M)^2 the inverse is damped, the more the nearer to singular (Nakamura, Hanafusa 1986)."""


@final
class Weighted:
    """min sum w_i q_i^2 subject to J q = u; see `weighted`."""

    name = "weighted"
    frame = Frame.HAND
    closes_residual = False

    def __init__(self, workspace: Workspace, mount: Mount, robot: PlanarRobot, base_weight: float) -> None:
        if not (math.isfinite(base_weight) and base_weight > 0.0):
            raise SetupError(f"base_weight must be a finite number > 0, got {base_weight:g}")
        self.workspace = workspace
        self.blend = step()
        self.mount = mount
        self._arm = robot.arm
        self._cheap = 1.0 / base_weight

    def split(self, l: float, psi: float, u_r: float, u_t: float) -> Split:
        """Return `split_joints` for the joints that put the hand at (l [m], psi [rad])."""
        return self.split_joints(inverse(l, psi, *self._arm.links, self._arm.elbow), u_r, u_t)

    def split_joints(self, theta: tuple[float, ...], u_r: float, u_t: float) -> Split:
        """Return q = W^-1 J^T M^-1 u, M = J W^-1 J^T (damped where it is nearly singular).

        q = (v_b, w_b, dtheta_1, dtheta_2), J of the true kinematics:
        J = [[c, k_r, 0, j_l], [-sn, k_t, l, l j_psi]], W = diag(base, base, 1, 1).
        """
        a, b = self._arm.links
        mount = self.mount
        l, psi = forward(theta[0], theta[1], a, b)
        c, sn = cos(psi + mount.yaw), sin(psi + mount.yaw)
        k_r = mount.s_x * sn - mount.s_y * c
        k_t = l + mount.s_x * c + mount.s_y * sn
        j_l, j_psi = jacobian(theta[1], a, b)
        w = self._cheap
        m_rr = w * (c * c + k_r * k_r) + j_l * j_l
        m_rt = w * (k_r * k_t - c * sn) + j_l * l * j_psi
        m_tt = w * (sn * sn + k_t * k_t) + l * l * (1.0 + j_psi * j_psi)
        det = m_rr * m_tt - m_rt * m_rt
        trace = m_rr + m_tt
        room = det / (NEAR * trace * trace)
        if room < 1.0:
            damping = NEAR * trace * (1.0 - room) * (1.0 - room)
            m_rr += damping
            m_tt += damping
            det = m_rr * m_tt - m_rt * m_rt
        y_r = (m_tt * u_r - m_rt * u_t) / det
        y_t = (m_rr * u_t - m_rt * u_r) / det
        v_b = w * (c * y_r - sn * y_t)
        w_b = w * (k_r * y_r + k_t * y_t)
        dtheta_1 = l * y_t
        dtheta_2 = j_l * y_r + l * j_psi * y_t
        if not math.isfinite(v_b + w_b + dtheta_1 + dtheta_2):
            return NO_SOLUTION
        return shared(psi, mount, u_r, v_b, w_b, (dtheta_1, dtheta_2), j_l, j_psi)


def weighted(
    workspace: Workspace | None = None,
    mount: Mount | None = None,
    robot: PlanarRobot | None = None,
    base_weight: float = BASE_WEIGHT,
) -> Weighted:
    """Baseline: weighted minimum-norm pseudo-inverse of the true kinematics, closed form, damped when singular."""
    return Weighted(workspace or Workspace(), mount or Mount(), robot or PlanarRobot(), base_weight)
