"""A lean whole step of the paper's quadratic program for the planar robot: what it costs at the least."""

from __future__ import annotations

import math
from typing import Any, final

import numpy as np

from overreach.baselines.qp import PaperQP
from overreach.baselines.solver import Array, solver
from overreach.model.model import channels
from overreach.model.planar import PlanarRobot


@final
class PlanarQP:
    """`baselines.qp.PaperQP` written out for two links, with floats alone up to the arrays of the solver (tested)."""

    def __init__(self, robot: PlanarRobot, solver_name: str, damping: float = PaperQP().damping) -> None:
        self._links, self._yaw = robot.arm.links, robot.mount.yaw
        self._solve = solver(solver_name)
        self.q_max: Array = np.array([channel.rate_max for channel in channels(robot)])
        self._least = -self.q_max
        self._damping = damping
        self._P: Any = np.eye(4) * (1.0 + damping)
        self._P[1, 2] = self._P[2, 1] = 1.0
        self._q: Any = np.zeros(4)

    def model(self, theta_1: float, theta_2: float, v_c: float, w_c: float) -> tuple[Array, Array]:
        """Return (P, q) for joints [rad] and a command; the two arrays are written anew at every call."""
        a, b = self._links
        f = b * math.sin(theta_2)
        e = a + b * math.cos(theta_2)
        l_2 = e * e + f * f
        j_l, j_psi = -a * f / math.sqrt(l_2), (l_2 - a * e) / l_2
        P, q = self._P, self._q
        c = math.cos(theta_1 + math.atan2(f, e) + self._yaw)
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

    def step(self, theta_1: float, theta_2: float, v_c: float, w_c: float) -> Array | None:
        """Return (v_b, w_b, dtheta_1, dtheta_2) for joints [rad] and a command: the whole step."""
        return self.solve(*self.model(theta_1, theta_2, v_c, w_c))
