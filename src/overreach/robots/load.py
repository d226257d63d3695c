"""Robots by name: an installed driver, or a description that is simulated."""

from __future__ import annotations

from collections.abc import Callable

from overreach.plugs import check_model_name, load_model, names, point
from overreach.robots.base import Robot
from overreach.robots.kinematic import KinematicRobot

ROBOTS = "overreach.robots"
"""Entry points to makers of a robot: (now [s]) -> Robot."""


def load_robot(name: str, now: float) -> Robot:
    """Return the robot called `name`, at rest at `now` [s]; raises UnknownNameError with the valid names."""
    if name in names(ROBOTS):
        maker: Callable[[float], Robot] = point(ROBOTS, name).load()
        return maker(now)
    check_robot_name(name)
    return KinematicRobot(load_model(name), now=now)


def check_robot_name(name: str) -> None:
    """Raise UnknownNameError, with the valid names, unless there is a robot called `name`; starts none."""
    if name not in names(ROBOTS):
        check_model_name(name, names(ROBOTS))
