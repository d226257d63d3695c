"""The paper's full planar step as a function of floats: what its law costs, beside ours and the quadratic programs."""

from __future__ import annotations

from math import atan2, cos, sin, sqrt

from overreach.arm.planar import SINE_DAMPED, joint_rates
from overreach.law.authority import Limits6, Mount3, paper
from overreach.law.blend import Rise


def paper_step(
    theta_1: float,
    theta_2: float,
    v_c: float,
    w_c: float,
    rise: Rise,
    limits: Limits6,
    mount: Mount3,
    a: float,
    b: float,
) -> tuple[float, float, float, float]:
    """Return (v_b [m/s], w_b, dtheta_1, dtheta_2 [rad/s]) for a command in the frame `polar`, with `paper`."""
    c2 = cos(theta_2)
    s2 = sin(theta_2)
    e = a + b * c2
    f = b * s2
    l = sqrt(e * e + f * f)
    psi = theta_1 + atan2(f, e)
    _, _, v_b, w_b, v_m, w_m, _ = paper(l, psi, v_c, w_c * l, rise, limits, mount)
    if -SINE_DAMPED < s2 < SINE_DAMPED:
        dtheta_1, dtheta_2, _ = joint_rates(c2, s2, l, v_m, w_m, a, b, 1)
        return v_b, w_b, dtheta_1, dtheta_2
    dtheta_2 = -v_m * l / (a * b * s2)  # as in `fast.step.planar_step`
    return v_b, w_b, w_m - b * (b + a * c2) / (l * l) * dtheta_2, dtheta_2
