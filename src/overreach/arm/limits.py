"""How fast each joint may still move, given how near its limit it is."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

from overreach.types import Channel


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


def room(joints: Sequence[Channel], theta: tuple[float, ...], dt: float) -> Room:
    """Return `fastest_towards` each limit for every joint, braking at half of the joint's acceleration limit."""
    return tuple(
        [
            (
                -fastest_towards(angle, -1.0, joint.lower, joint.upper, joint.rate_max, 0.5 * joint.change_max, dt),
                fastest_towards(angle, 1.0, joint.lower, joint.upper, joint.rate_max, 0.5 * joint.change_max, dt),
            )
            for angle, joint in zip(theta, joints, strict=True)
        ]
    )
