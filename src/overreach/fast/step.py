"""The full planar step as a function of floats: forward kinematics, command frame, law, joint rates."""

from __future__ import annotations

from math import atan2, cos, sin, sqrt

from overreach.arm.planar import SINE_DAMPED, joint_rates
from overreach.law.authority import Limits6, Mount3, exact
from overreach.law.blend import Rise


def planar_step(
    theta_1: float,
    theta_2: float,
    theta_b: float,
    theta_e: float,
    v_c: float,
    w_c: float,
    rise: Rise,
    limits: Limits6,
    mount: Mount3,
    a: float,
    b: float,
) -> tuple[float, float, float, float]:
    """Return (v_b [m/s], w_b, dtheta_1, dtheta_2 [rad/s]) for a command in the frame `hand`, with `exact`."""
    c2 = cos(theta_2)
    s2 = sin(theta_2)
    e = a + b * c2
    f = b * s2
    l = sqrt(e * e + f * f)
    psi = theta_1 + atan2(f, e)
    delta = theta_e - theta_b - psi - mount[2]
    _, _, v_b, w_b, v_m, w_m, _ = exact(l, psi, v_c * cos(delta), v_c * sin(delta) + w_c * l, rise, limits, mount)
    if -SINE_DAMPED < s2 < SINE_DAMPED:
        dtheta_1, dtheta_2, _ = joint_rates(c2, s2, l, v_m, w_m, a, b, 1)
        return v_b, w_b, dtheta_1, dtheta_2
    # Away from the singularities: the two lines of `joint_rates` themselves, for the call costs a tenth of the step.
    dtheta_2 = -v_m * l / (a * b * s2)
    return v_b, w_b, w_m - b * (b + a * c2) / (l * l) * dtheta_2, dtheta_2
