"""How fast each joint may still move, given how near its limit it is."""

from __future__ import annotations

from math import sqrt

from overreach.model.planar import Arm2R


def fastest_towards(
    theta: float, dtheta: float, least: float, most: float, speed: float, braking: float, dt: float
) -> float:
    """Return the greatest |dtheta| [rad/s] allowed in the direction of `dtheta` at `theta` [rad].

    min(speed, sqrt(2 braking d), d/dt), braking [rad/s^2], with d the distance to the limit ahead [rad]: the joint can
    always stop before it. Away from a limit the joint's own speed is allowed: backing out always works.
    """
    ahead = most - theta if dtheta >= 0.0 else theta - least
    if ahead <= 0.0:
        return 0.0
    return min(speed, sqrt(2.0 * braking * ahead), ahead / dt)


Room = tuple[tuple[float, float], ...]
"""Per joint the least and the greatest rate [rad/s] that are allowed."""


def room(arm: Arm2R, theta: tuple[float, ...], dt: float) -> Room:
    """Return `fastest_towards` both ends for every joint of `arm`, braking at half of what the joint can."""
    return tuple(
        [
            (
                -fastest_towards(angle, -1.0, least, most, speed, 0.5 * braking, dt),
                fastest_towards(angle, 1.0, least, most, speed, 0.5 * braking, dt),
            )
            for angle, least, most, speed, braking in zip(
                theta, arm.theta_min, arm.theta_max, arm.dtheta_max, arm.ddtheta_max, strict=True
            )
        ]
    )
