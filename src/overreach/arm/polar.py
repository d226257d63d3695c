"""The plane seen from the shoulder: what is the same for every arm."""

from __future__ import annotations

from math import cos, pi, sin


def wrap(angle: float) -> float:
    """Return `angle` [rad] brought to (-pi, pi]."""
    if -pi < angle <= pi:
        return angle
    turned = angle % (2.0 * pi)
    return turned - 2.0 * pi if turned > pi else turned


def hand_in_world(
    x_b: float, y_b: float, theta_b: float, l: float, psi_d: float, s_x: float, s_y: float
) -> tuple[float, float]:
    """Return the hand's position [m] in the world, for a base pose and (l, psi_d) about the shoulder s."""
    c, s = cos(theta_b), sin(theta_b)
    p_x = s_x + l * cos(psi_d)
    p_y = s_y + l * sin(psi_d)
    return x_b + c * p_x - s * p_y, y_b + s * p_x + c * p_y
