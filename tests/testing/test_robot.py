from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import msgspec
import pytest

from overreach.model.planar import planar
from overreach.robots.base import Robot
from overreach.robots.imperfect import Imperfection
from overreach.robots.kinematic import KinematicRobot
from overreach.robots.load import load_robot
from overreach.testing.robot import check_robot
from overreach.types import BaseTwist, RobotState
from tests.serial import SerialRobot, seven


@pytest.mark.parametrize(
    "imperfection",
    [Imperfection(), Imperfection(lag_s=0.1, delay_s=0.02, gain=0.97), Imperfection(feedback_s=0.01)],
    ids=["ideal", "slow", "now and then"],
)
def test_the_simulated_robot_conforms(imperfection: Imperfection) -> None:
    """Ideal or not, the kinematic robot keeps what a robot promises."""
    check_robot(lambda now: KinematicRobot(imperfection=imperfection, now=now))


def test_robots_by_name_conform() -> None:
    """A robot that is loaded by its name is one."""
    check_robot(lambda now: load_robot("planar", now))
    check_robot(lambda now: load_robot("mobile4", now))
    check_robot(lambda now: load_robot("omni5", now))


def test_a_robot_with_an_arm_in_space_conforms() -> None:
    """The same simulation carries any model: here an arm of seven joints."""
    check_robot(lambda now: KinematicRobot(SerialRobot(seven()), now=now))


class Altered:
    """The planar robot, but for what is changed."""

    simulated = True

    def __init__(self, now: float, read: Callable[[RobotState], RobotState], write: Callable[..., Any]) -> None:
        self._robot = KinematicRobot(now=now)
        self.model = planar()
        self._read, self._write = read, write

    def read(self, now: float) -> RobotState:
        return self._read(self._robot.read(now))

    def write(self, base: BaseTwist, joints: tuple[float, ...], gripper: float | None, now: float, end: float) -> None:
        base, joints = self._write(base, joints)
        self._robot.write(base, joints, gripper, now, end)

    def stop(self, now: float) -> None:
        base, joints = self._write(BaseTwist(0.0, 0.0, 0.0), (0.0, 0.0))
        self._robot.write(base, joints, None, now, now)

    def arm(self, now: float) -> None:
        self._robot.arm(now)

    def restart(self, now: float) -> None:
        self._robot.read(now)


def same(state: RobotState) -> RobotState:
    return state


def asked(base: BaseTwist, joints: tuple[float, ...]) -> tuple[BaseTwist, tuple[float, ...]]:
    return base, joints


def changed(**fields: Any) -> Callable[[RobotState], RobotState]:
    return lambda state: msgspec.structs.replace(state, **fields)


def pose(**fields: Any) -> Callable[[RobotState], RobotState]:
    return lambda state: msgspec.structs.replace(state, pose=msgspec.structs.replace(state.pose, **fields))


@pytest.mark.parametrize(
    ("read", "write", "says"),
    [
        (changed(q=(0.1,)), asked, "reports 1 joints"),
        (changed(dq=(0.0, math.nan)), asked, "not finite"),
        (pose(z=math.inf), asked, "not finite"),
        (changed(gripper=0), asked, "not Python's own floats"),
        (pose(q_w=0.5, q_z=0.0), asked, "no unit quaternion"),
        (changed(t=1e9), asked, "ahead of the clock"),
        (changed(t=5.0), asked, "does not go on"),
        (changed(dq=(0.2, 0.0)), asked, "moves before it is asked to"),
        (same, lambda base, joints: (base, (joints[1], joints[0])), "was asked for"),
        (same, lambda base, joints: (base, (-joints[0], joints[1])), "was asked for"),
        (same, lambda base, joints: (BaseTwist(0.5 * base.v_x, 0.0, base.w_z), joints), "was asked for"),
        (changed(dq=(0.0, 0.0), q=(0.1, 0.2)), asked, "was asked for"),
        (same, lambda base, joints: (base, (max(0.01, joints[0]), joints[1])), "does not come to rest"),
    ],
)  # fmt: skip
def test_a_robot_that_breaks_a_promise_is_found_out(
    read: Callable[[RobotState], RobotState], write: Callable[..., Any], says: str
) -> None:
    """The suite can fail: each promise, broken, is named."""
    with pytest.raises(AssertionError, match=says):
        check_robot(lambda now: Altered(now, read, write))


def test_a_stop_and_a_restart_that_are_none_are_found_out() -> None:
    """A stop after which the robot moves, and a restart that leaves it where it is, are named."""

    class Rolls(Altered):
        def stop(self, now: float) -> None:
            self._robot.write(BaseTwist(0.1, 0.0, 0.0), (0.0, 0.0), None, now, now)

    with pytest.raises(AssertionError, match="moves after stop"):
        check_robot(lambda now: Rolls(now, same, asked))
    with pytest.raises(AssertionError, match="off the start"):
        check_robot(lambda now: Altered(now, same, asked))


def test_a_robot_that_lacks_a_part_is_found_out() -> None:
    """The suite names what a robot must have and one has not."""

    class Partial:
        model, simulated = planar(), True

    made: Callable[[float], Robot] = lambda now: Partial()  # type: ignore[assignment,return-value]  # noqa: E731
    with pytest.raises(AssertionError, match="lacks read, write, arm, stop, restart"):
        check_robot(made)
