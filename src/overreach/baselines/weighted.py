"""The cheap rival: a weighted minimum-norm pseudo-inverse, in closed form."""

from __future__ import annotations

import math
from typing import Annotated, Any

from overreach.arm.chain import Chain
from overreach.baselines.common import UNSOLVED, Rows, base_rows, commanded, planned
from overreach.extras import require
from overreach.law.body import Planner, WholeBody
from overreach.model.model import Model
from overreach.parameters import number
from overreach.types import HandTwist, Plan, Twist

NEAR = 0.01
"""Below det M = NEAR (trace M)^2 the inverse is damped, the more the nearer to singular (Nakamura, Hanafusa 1986)."""

NEAR_IN_SPACE = 1e-4
"""The same for more rows than two, of the least eigenvalue of M against its trace."""


class Weighted(WholeBody, frozen=True):
    """Baseline: weighted minimum-norm pseudo-inverse of the true kinematics, closed form, damped when singular.

    min sum w_i q_i^2 subject to J q = u, q = (v_b, w_b, joints), W = diag(base_weight, base_weight, 1, ...).
    """

    name = "weighted"
    closes_residual = False
    base_weight: Annotated[float, number("weight of the base's rates", "", 0.1, 100.0, 0.1, above=0.0)] = 1.0
    """How much dearer a rate of the base [m/s, rad/s] is than one of a joint [rad/s]. 1: the plain pseudo-inverse."""

    def planner(self, model: Model) -> Planner:
        """Return q = W^-1 J^T M^-1 u, M = J W^-1 J^T (damped where it is nearly singular)."""
        mount, rows, w = model.mount, model.arm.rows, 1.0 / self.base_weight
        solve = _in_the_plane if rows == (0, 1) else _Rows(rows)

        def plan(chain: Chain, u: HandTwist, _base: Twist) -> Plan:
            base, arm = base_rows(chain, mount), chain.jacobian()
            rates = solve(chain.l, base, arm, w, u)
            if not math.isfinite(sum(rates)):
                return UNSOLVED
            return planned(rates, chain, base, u.u_r)

        return plan


def _in_the_plane(l: float, base: Rows, arm: Rows, w: float, u: HandTwist) -> list[float]:
    """Return the rates for the rows r and t: M is 2 x 2, and its inverse is written out."""
    (c, k_r), (m_sn, k_t) = base[0], base[1]
    u_r, u_t = u.u_r, u.u_t
    m_rr = w * (c * c + k_r * k_r) + sum([j_l * j_l for j_l in arm[0]])
    m_rt = w * (k_r * k_t + c * m_sn) + sum([j_l * l * j_psi for j_l, j_psi in zip(arm[0], arm[1], strict=True)])
    m_tt = w * (m_sn * m_sn + k_t * k_t) + l * l * sum([j_psi * j_psi for j_psi in arm[1]])
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
    return [
        w * (c * y_r + m_sn * y_t),
        w * (k_r * y_r + k_t * y_t),
        *[j_l * y_r + l * j_psi * y_t for j_l, j_psi in zip(arm[0], arm[1], strict=True)],
    ]


class _Rows:
    """The same for an arm that has more rows than the plane's, by numpy."""

    def __init__(self, rows: tuple[int, ...]) -> None:
        self._numpy: Any = require("numpy", "qp", "the law weighted on an arm like this")
        self._rows = list(rows)

    def __call__(self, l: float, base: Rows, arm: Rows, w: float, u: HandTwist) -> list[float]:
        numpy, rows = self._numpy, self._rows
        J = numpy.hstack((numpy.array(base), numpy.array(arm)))
        J[1, 2:] *= l  # from bearings to the tangent
        J = J[rows]
        cheap = numpy.ones(J.shape[1])
        cheap[:2] = w
        M = (J * cheap) @ J.T
        trace = numpy.trace(M)
        room = numpy.linalg.eigvalsh(M)[0] / (NEAR_IN_SPACE * trace)
        if room < 1.0:
            M += numpy.eye(len(rows)) * NEAR_IN_SPACE * trace * (1.0 - room) ** 2
        y = numpy.linalg.solve(M, numpy.array(commanded(u))[rows])
        rates: list[float] = (cheap * (J.T @ y)).tolist()
        return rates
