"""The 2R arm in closed form: joints <-> the hand's polar coordinates about the shoulder.

With links a, b [m], joints theta_1, theta_2 [rad], e = a + b cos theta_2, f = b sin theta_2:
    l = sqrt(e^2 + f^2),   psi = theta_1 + atan2(f, e)
"""

from __future__ import annotations

from math import acos, atan2, copysign, cos, hypot, pi, sin

from overreach.types import Verdict

SINE_DAMPED = 0.15
"""Below this |sin theta_2| the inverse of the Jacobian is damped: within 9 degrees of straight or folded."""

L_LEAST = 1e-6
"""Shortest length [m] that is divided by: at l = 0 the bearing has no meaning."""


def wrap(angle: float) -> float:
    """Return `angle` [rad] brought to (-pi, pi]."""
    if -pi < angle <= pi:
        return angle
    turned = angle % (2.0 * pi)
    return turned - 2.0 * pi if turned > pi else turned


def forward(theta_1: float, theta_2: float, a: float, b: float) -> tuple[float, float]:
    """Return (l [m], psi [rad], not wrapped) of the hand."""
    e = a + b * cos(theta_2)
    f = b * sin(theta_2)
    return hypot(e, f), theta_1 + atan2(f, e)


def inverse(l: float, psi: float, a: float, b: float, elbow: int) -> tuple[float, float]:
    """Return (theta_1, theta_2) [rad] that put the hand at (l, psi), with theta_2 of the sign `elbow`.

    The two solutions are those of elbow = +1 and -1. l is held to the reach [|a - b|, a + b].
    """
    cosine = (l * l - a * a - b * b) / (2.0 * a * b)
    theta_2 = elbow * acos(max(-1.0, min(1.0, cosine)))
    return psi - atan2(b * sin(theta_2), a + b * cos(theta_2)), theta_2


def jacobian(theta_2: float, a: float, b: float) -> tuple[float, float]:
    """Return (j_l, j_psi), the second column of the polar Jacobian; the first is (0, 1).

    j_l = dl/dtheta_2 = -a b sin theta_2 / l [m/rad],   j_psi = dpsi/dtheta_2 = b (b + a cos theta_2) / l^2
    """
    c2 = cos(theta_2)
    l = max(hypot(a + b * c2, b * sin(theta_2)), L_LEAST)
    return -a * b * sin(theta_2) / l, b * (b + a * c2) / (l * l)


def polar_rates(theta_2: float, dtheta_1: float, dtheta_2: float, a: float, b: float) -> tuple[float, float]:
    """Return (v_m = dl/dt [m/s], w_m = dpsi/dt [rad/s]) for joint rates [rad/s]."""
    j_l, j_psi = jacobian(theta_2, a, b)
    return j_l * dtheta_2, dtheta_1 + j_psi * dtheta_2


def hand_in_world(
    x_b: float, y_b: float, theta_b: float, l: float, psi_d: float, s_x: float, s_y: float
) -> tuple[float, float]:
    """Return the hand's position [m] in the world, for a base pose and (l, psi_d) about the shoulder s."""
    c, s = cos(theta_b), sin(theta_b)
    p_x = s_x + l * cos(psi_d)
    p_y = s_y + l * sin(psi_d)
    return x_b + c * p_x - s * p_y, y_b + s * p_x + c * p_y


def joint_rates(
    c2: float,
    s2: float,
    l: float,
    v_m: float,
    w_m: float,
    a: float,
    b: float,
    elbow: int,
) -> tuple[float, float, bool]:
    """Return (dtheta_1, dtheta_2 [rad/s], damped) for the hand's v_m = dl/dt [m/s], w_m = dpsi/dt [rad/s].

    c2, s2: cosine and sine of theta_2; l: the length [m] that belongs to it.
        dtheta_2 = v_m / j_l,   dtheta_1 = w_m - j_psi dtheta_2
    Near theta_2 = 0 or pi, where j_l goes to 0, motion towards the singularity is damped (it gives
    way smoothly) and motion away from it is bounded but not blocked, so that backing out is always
    possible. Never infinite.
    """
    l = max(l, L_LEAST)
    damped = False
    if -SINE_DAMPED < s2 < SINE_DAMPED:
        damped = v_m != 0.0
        if (v_m > 0.0) == (c2 > 0.0):
            dtheta_2 = -v_m * l * s2 / (a * b * SINE_DAMPED * SINE_DAMPED)
        else:
            side = copysign(SINE_DAMPED, s2 if s2 != 0.0 else elbow)
            dtheta_2 = -v_m * l / (a * b * side)
    else:
        dtheta_2 = -v_m * l / (a * b * s2)
    return w_m - b * (b + a * c2) / (l * l) * dtheta_2, dtheta_2, damped


def polar_to_joint_rates(
    theta_2: float, v_m: float, w_m: float, a: float, b: float, elbow: int
) -> tuple[float, float, bool]:
    """Return `joint_rates` for the joint angle theta_2 [rad]."""
    c2 = cos(theta_2)
    s2 = sin(theta_2)
    return joint_rates(c2, s2, hypot(a + b * c2, b * s2), v_m, w_m, a, b, elbow)


def joint_rates_over(
    theta_1: float, theta_2: float, v_m: float, w_m: float, dt: float, a: float, b: float, elbow: int
) -> tuple[float, float, Verdict]:
    """Return joint rates [rad/s] that, held for dt [s], take the hand to exactly (l + v_m dt, psi + w_m dt).

    The paper's Algorithm 1, lines 33 to 35. At the ends of the reach l stays there, with the verdict
    OUT_OF_REACH, else MOVING.
    """
    l, psi = forward(theta_1, theta_2, a, b)
    target = l + v_m * dt
    held = max(abs(a - b), min(a + b, target))
    end_1, end_2 = inverse(held, psi + w_m * dt, a, b, elbow)
    verdict = Verdict.MOVING if held == target else Verdict.OUT_OF_REACH
    return (end_1 - theta_1) / dt, (end_2 - theta_2) / dt, verdict
