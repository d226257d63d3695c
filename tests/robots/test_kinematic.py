from __future__ import annotations

import math
import statistics

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from overreach.errors import SetupError, WorkspaceError
from overreach.model.planar import load_planar
from overreach.robots.arc import arc
from overreach.robots.imperfect import Imperfection
from overreach.robots.kinematic import KinematicRobot
from tests.said import drives
from tests.strategies import angles

REST = (0.0, 0.0)


@given(*[st.floats(-5, 5)] * 2, angles, *[st.floats(-1, 1)] * 2, st.floats(-3, 3), st.floats(0, 10))
def test_arc_is_the_matrix_exponential(
    x: float, y: float, theta: float, v: float, v_y: float, w: float, dt: float
) -> None:
    """The base's arc is the pose times exp(twist dt) in SE(2), for any step and for w = 0."""
    c, s = math.cos(theta), math.sin(theta)
    pose = np.array([[c, -s, x], [s, c, y], [0, 0, 1]])
    after = pose @ expm(np.array([[0.0, -w, v], [w, 0.0, v_y], [0.0, 0.0, 0.0]]) * dt)
    got = arc(x, y, theta, v, w, dt, v_y)
    assert got[:2] == pytest.approx((after[0, 2], after[1, 2]), abs=1e-9)
    assert got[2] == theta + w * dt


@given(st.floats(-1, 1), st.floats(-2, 2), st.lists(st.floats(0.001, 0.5), min_size=2, max_size=8))
def test_steps_add_up(v: float, w: float, pieces: list[float]) -> None:
    """Reading the robot more often does not change where it goes: integration is exact, not Euler's."""
    once, often = KinematicRobot(), KinematicRobot()
    for robot in (once, often):
        robot.write(drives(v, w), (0.3, -0.2), None, 0.0, 0.0)
    t = 0.0
    for piece in pieces:
        t += piece
        often.read(t)
    one, other = once.read(t), often.read(t)
    assert (one.x_b, one.y_b, one.theta_b) == pytest.approx((other.x_b, other.y_b, other.theta_b), abs=1e-12)
    assert one.q == pytest.approx(other.q, abs=1e-12)


def test_joints_stop_at_their_limits() -> None:
    """A joint that is driven into its limit stays there, and comes back from it."""
    robot = KinematicRobot()
    robot.write(drives(), (3.0, 3.0), None, 0.0, 0.0)
    ends = tuple(joint.upper for joint in robot.model.arm.channels)
    assert robot.read(100.0).q == ends
    robot.write(drives(), (-1.0, -1.0), None, 100.0, 100.0)
    assert robot.read(101.0).q == pytest.approx([limit - 1.0 for limit in ends])


@given(st.floats(0.01, 0.5), st.floats(0.02, 2.0))
def test_lag_is_first_order(lag: float, t: float) -> None:
    """After a step the twist is 1 - exp(-t/tau) of it, and the base has gone the integral of that."""
    robot = KinematicRobot(imperfection=Imperfection(lag_s=lag))
    robot.write(drives(0.4, 0.0), REST, None, 0.0, 0.0)
    state = robot.read(t)
    assert state.v_b == pytest.approx(0.4 * (1.0 - math.exp(-t / lag)), abs=1e-9)
    assert state.x_b == pytest.approx(0.4 * (t - lag * (1.0 - math.exp(-t / lag))), abs=1e-9)


@given(st.floats(0.01, 0.3), st.floats(0.0, 0.5))
def test_delay_is_dead_time(delay: float, after: float) -> None:
    """Nothing moves for the dead time; then all moves as it would have without."""
    robot = KinematicRobot(imperfection=Imperfection(delay_s=delay))
    robot.write(drives(0.4, 0.0), REST, None, 0.0, 0.0)
    assert robot.read(delay * 0.999).x_b == 0.0
    assert robot.read(delay + after).x_b == pytest.approx(0.4 * after, abs=1e-9)


def test_noise_is_seeded_and_as_wide_as_asked() -> None:
    """The same seed gives the same noise; its spread is the one asked for; the true state has none."""
    robots = [KinematicRobot(imperfection=Imperfection(noise=0.01, seed=7)) for _ in range(2)]
    seen = [[robot.read(0.0).q[0] for _ in range(4000)] for robot in robots]
    assert seen[0] == seen[1]
    assert statistics.stdev(seen[0]) == pytest.approx(0.01, rel=0.05)
    assert robots[0].true.q == KinematicRobot().true.q


def test_restart_is_the_start() -> None:
    """A restarted robot is where it began, at rest."""
    robot = KinematicRobot(psi=0.3)
    start = robot.true
    robot.write(drives(0.4, 0.2), (0.1, 0.1), None, 0.0, 0.0)
    robot.read(3.0)
    robot.restart(0.0)
    assert robot.true == start


def test_setup_errors() -> None:
    """A start out of reach and an imperfection that cannot be are refused at set-up."""
    with pytest.raises(WorkspaceError, match="reach"):
        KinematicRobot(l=1.2)
    with pytest.raises(SetupError, match="lag_s"):
        Imperfection(lag_s=-0.1)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("name = 1", "str"),
        ("[arm]\nlinks = [0.5]", "length 2"),
        ("[arm]\nlinks = [0.5, -1.0]", "links"),
        ("[arm]\nelbow = 2", "elbow"),
        ("[workspace]\nl_max = 3.0", "reach"),
        ("[start]\nl = 0.0", "reach"),
        ("[base]\nv_max = inf", "v_max"),
        ("[base]\ndw_max = 0.0", "dw_max"),
        ("[base]\nw_max = -1.0", "w_max"),
        ("[base]\nlag = nan", "lag"),
        ("[arm]\ndtheta_max = [3.0, nan]", "dtheta_max"),
        ("[arm]\nddtheta_max = [0.0, 20.0]", "ddtheta_max"),
        ("[arm]\ntheta_min = [-4.8, 3.2]", "theta_min"),
        ("= 3", "robot description"),
    ],
)
def test_robot_files_say_what_is_wrong(text: str, says: str) -> None:
    """A robot's file that cannot be used says what is wrong in it."""
    with pytest.raises(SetupError, match=says):
        load_planar(text)
