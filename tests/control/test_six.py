"""Six directions: what each part of a twist does to the hand, in every frame and mode, by the kinematics at the end."""

from __future__ import annotations

import math

import numpy as np
import pytest

from overreach.arm.spatial.arm import SpatialArm
from overreach.arm.spatial.attitude import turned, vector
from overreach.arm.spatial.screws import Array
from overreach.control.pilot import Pilot, obeys
from overreach.law.laws import Exact, usual_blend
from overreach.model.described import DescribedRobot
from overreach.plugs import load_model
from overreach.requests import ArmRequest
from overreach.robots.kinematic import KinematicRobot
from overreach.types import Command, Frame, RobotState, Twist
from overreach.verdicts import Verdict

DT = 0.01
Z = np.array((0.0, 0.0, 1.0))


def robot_called(name: str) -> DescribedRobot:
    model = load_model(name)
    assert isinstance(model, DescribedRobot)
    return model


def pose(model: DescribedRobot, state: RobotState) -> tuple[Array, Array]:
    """Return the hand's place and attitude in the world."""
    chain = model.arm.at(state.q, model.mount)
    turn = turned(state.theta_b * Z)
    return turn @ np.array(chain.hand) + (state.x_b, state.y_b, 0.0), turn @ chain.attitude


def bearing_of(model: DescribedRobot, state: RobotState) -> float:
    return state.theta_b + model.mount.yaw + model.arm.at(state.q, model.mount).psi


def drive(
    model: DescribedRobot, frame: Frame, twist: Twist, seconds: float, psi: float = 0.2
) -> list[tuple[RobotState, RobotState, Verdict, float]]:
    """Return the states before and after each period of a drive, with what was said, and the hand's own heading."""
    pilot = Pilot(model, Exact(usual_blend(Exact().blend, model)))
    robot = KinematicRobot(model, psi=psi)
    pilot.ask(ArmRequest(1), 0.0)
    periods = []
    for k in range(round(seconds / DT)):
        now = k * DT
        before = robot.read(now)
        tick = pilot.tick(before, Command(1, k + 1, 1, True, twist, frame, seen=now), now, DT)
        robot.write(tick.base, tick.joints, tick.gripper, now, now + DT)
        periods.append((before, robot.read(now + DT), tick.verdict, tick.polar.theta_e))
    return periods


def level(angle: float) -> Array:
    """Return the axes, x and y along the ground, of a frame whose x axis has this heading."""
    return turned(angle * Z)


def axes_of(model: DescribedRobot, frame: Frame, state: RobotState, theta_e: float) -> Array:
    """Return the axes that a twist is along, in the world."""
    match frame:
        case Frame.HAND:
            return level(theta_e)
        case Frame.POLAR:
            return level(bearing_of(model, state))
        case Frame.BASE:
            return level(state.theta_b)
        case Frame.WORLD:
            return np.eye(3)
        case Frame.TOOL:
            _, R = pose(model, state)
            ahead = R @ np.array(model.arm.manner.approach)
            left = np.cross(R @ model.arm.R_home.T @ Z, ahead)
            left /= np.linalg.norm(left)
            return np.stack((ahead, left, np.cross(ahead, left)), axis=1)


SLOW = Twist(0.05, -0.04, 0.02, 0.11, -0.07, 0.06)


@pytest.mark.parametrize("frame", Frame)
@pytest.mark.parametrize("name", ["mobile7", "mobile7#fixed", "omni7"])
def test_an_arm_that_holds_all_is_turned_about_every_axis(name: str, frame: Frame) -> None:
    """Place and attitude both go as the twist says, along the frame's axes, to 1e-4: the sweep and the yaw in words.

    w_z sweeps the hand about the shoulder, and it yaws with its bearing or, where fixed, at w_z. In the frame of the
    tool it turns in its place.
    """
    model = robot_called(name)
    for before, after, verdict, theta_e in drive(model, frame, SLOW, 2.0)[30:]:
        assert verdict is Verdict.MOVING
        axes = axes_of(model, frame, before, theta_e)
        (p, R), (p_1, R_1) = pose(model, before), pose(model, after)
        bearing = bearing_of(model, before)
        swept = 0.0 if frame is Frame.TOOL else SLOW.w_z
        arm = model.arm.at(before.q, model.mount).l * np.array((-math.sin(bearing), math.cos(bearing), 0.0))
        v = axes @ (SLOW.v_x, SLOW.v_y, SLOW.v_z) + swept * arm
        assert np.abs((p_1 - p) / DT - v).max() < 1e-4
        yaw = SLOW.w_z if model.mode == "fixed" else (bearing_of(model, after) - bearing) / DT
        if frame is Frame.TOOL:
            w = axes @ (SLOW.w_x, SLOW.w_y, SLOW.w_z) + (0.0 if model.mode == "fixed" else yaw) * Z
        else:
            w = axes @ (SLOW.w_x, SLOW.w_y, 0.0) + yaw * Z
        assert np.abs(vector(R_1 @ R.T) / DT - w).max() < 1e-3


@pytest.mark.parametrize("frame", Frame)
def test_an_arm_of_five_joints_pitches_and_rolls(frame: Frame) -> None:
    """w_y pitches the hand across its bearing, w_x rolls it about its own axis, whatever the frame is."""
    model = robot_called("omni5")
    twist = Twist(0.02, 0.0, 0.0, 0.2, 0.15, 0.0)
    periods = drive(model, frame, twist, 1.5, psi=0.0)
    start, end = pose(model, periods[29][0])[1], pose(model, periods[-1][1])[1]
    a, b = [level(-bearing_of(model, state)) @ R for state, R in ((periods[29][0], start), (periods[-1][1], end))]
    ahead, ahead_1 = a[:, 0], b[:, 0]
    seconds = len(periods[29:]) * DT
    pitched = math.atan2(-ahead_1[2], ahead_1[0]) - math.atan2(-ahead[2], ahead[0])
    assert pitched == pytest.approx(0.15 * seconds, abs=2e-3)
    rolled = vector(turned(np.array((0.0, pitched, 0.0))).T @ b @ a.T)
    assert abs(rolled @ ahead) == pytest.approx(0.2 * seconds, abs=2e-3)
    assert all(verdict is Verdict.MOVING for _, _, verdict, _ in periods[30:])


def test_what_an_arm_lacks_is_refused_and_named() -> None:
    """A roll for an arm of four joints: nothing moves, and it is said what there is not."""
    assert {"v_z", "w_y"} <= obeys(robot_called("mobile4"))
    assert "w_x" not in obeys(robot_called("mobile4"))
    assert {"w_x", "w_y"} <= obeys(robot_called("omni5"))
    assert {"w_x", "w_y", "gripper"} <= obeys(robot_called("mobile7"))
    assert {"w_x", "w_y"}.isdisjoint(obeys(robot_called("mobile7#free")))
    periods = drive(robot_called("mobile4"), Frame.HAND, Twist(w_x=0.1), 0.5, psi=0.0)
    assert periods[0][0].q == periods[-1][1].q
    assert all(verdict is Verdict.NO_SUCH_MOTION for _, _, verdict, _ in periods)


@pytest.mark.parametrize("name", ["mobile7", "mobile7#fixed", "omni5", "mobile4"])
def test_a_turned_hand_stays_turned(name: str) -> None:
    """It is turned, let go, driven elsewhere and across limits: it keeps what it was turned to, to 1e-3 rad.

    A fixed yaw excepted, which yields.
    """
    model = robot_called(name)
    pilot = Pilot(model, Exact(usual_blend(Exact().blend, model)))
    robot = KinematicRobot(model)
    pilot.ask(ArmRequest(1), 0.0)
    v = model.command.v_c
    parts = [(Twist(w_y=0.2), 1.0, True), (Twist(), 0.5, False), (Twist(v), 4.0, True), (Twist(-v, w_z=0.2), 4.0, True)]
    now, k, grip, held = 0.0, 0, 1, []
    for twist, seconds, presses in parts:
        for _ in range(round(seconds / DT)):
            k += 1
            tick = pilot.tick(robot.read(now), Command(1, k, grip, presses, twist, Frame.HAND, seen=now), now, DT)
            robot.write(tick.base, tick.joints, None, now, now + DT)
            now += DT
            state = robot.read(now)
            _, R = pose(model, state)
            ahead = level(-bearing_of(model, state)) @ R @ np.array(model.arm.manner.approach)
            held.append(math.atan2(ahead[2], math.hypot(ahead[0], ahead[1])))
        grip += 1
    first = held[round(1.5 / DT) - 1]
    assert abs(first - held[0]) > 0.15
    assert np.abs(np.array(held[round(1.5 / DT) :]) - first).max() < 1e-3


@pytest.mark.parametrize("part", ["v_x", "v_y", "v_z"])
def test_the_tool_s_axes_keep_the_speeds_along_the_ground_and_up(part: str) -> None:
    """However the hand points, it goes up and down no faster than v_z, and along the ground than v."""
    model = robot_called("mobile7")
    pilot = Pilot(model, Exact(usual_blend(Exact().blend, model)))
    robot = KinematicRobot(model)
    pilot.ask(ArmRequest(1), 0.0)
    most = model.command
    for k in range(500):
        now = k * DT
        turning = k < 300
        twist = Twist(w_y=0.3) if turning else Twist(**{part: 0.3})
        before = robot.read(now)
        tick = pilot.tick(before, Command(1, k + 1, 1, True, twist, Frame.TOOL, seen=now), now, DT)
        robot.write(tick.base, tick.joints, None, now, now + DT)
        v = (pose(model, robot.read(now + DT))[0] - pose(model, before)[0]) / DT
        assert math.hypot(v[0], v[1]) <= most.v_c * 1.001
        assert abs(v[2]) <= most.v_z * 1.001
        if k > 400 and part in ("v_x", "v_z"):
            assert tick.verdict is Verdict.SPEED
            assert np.linalg.norm(v) > 0.06


def test_a_restart_holds_the_hand_as_at_home() -> None:
    """After the robot is put to its start, the attitude that it was turned to is forgotten."""
    model = robot_called("mobile7")
    controller, robot = Pilot(model).controller, KinematicRobot(model)
    for k in range(40):
        now = k * DT
        decision = controller.decide(robot.read(now), Twist(w_y=0.02 * min(k, 10)), DT, now=now, frame=Frame.HAND)
        robot.write(decision.base, decision.joints, None, now, now + DT)
    assert decision.attitude is not None
    robot.restart(1.0)
    controller.restart()
    assert controller.decide(robot.read(1.0), Twist(v_x=0.01), DT, now=1.0).attitude is None


def test_tool_axes_of_every_home() -> None:
    """Forward is where the hand points; left, and up, which is up at home, or ahead where the hand points down."""
    for name in ("mobile7", "mobile4", "omni5"):
        arm = robot_called(name).arm
        assert isinstance(arm, SpatialArm)
        axes = arm.R_home @ arm.tool
        assert np.abs(axes.T @ axes - np.eye(3)).max() < 1e-12
        assert np.linalg.det(axes) == pytest.approx(1.0)
        assert axes[:, 0] == pytest.approx(arm.R_home @ np.array(arm.manner.approach))
        assert axes[2, 2] > 0.0
