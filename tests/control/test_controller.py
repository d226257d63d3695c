from __future__ import annotations

import math
import random
from itertools import pairwise

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from overreach.arm.planar import inverse
from overreach.baselines.weighted import Weighted
from overreach.control.controller import HandController
from overreach.law.authority import ee_velocity
from overreach.law.blend import Step
from overreach.law.laws import Exact, Paper
from overreach.model.model import channels
from overreach.model.planar import planar
from overreach.model.workspace import Workspace
from overreach.plugs import law_names, load_law
from overreach.robots.kinematic import KinematicRobot
from overreach.run.law_alone import LawAlone
from overreach.types import Frame
from overreach.verdicts import Verdict
from tests.said import push
from tests.states import put
from tests.strategies import speeds

DT = 0.005


class Closing(Weighted, frozen=True):
    """The pseudo-inverse, and the arm makes up for the base."""

    closes_residual = True


@settings(max_examples=60)
@given(st.sampled_from(law_names(planar())), st.integers(0, 10**6))
def test_no_limit_is_ever_passed(name: str, seed: int) -> None:
    """Under any commands and any law, base and joints keep their limits of speed and acceleration, always."""
    law = load_law(name)
    robot = KinematicRobot()
    controller = HandController(robot.model, law)
    each = channels(robot.model)
    chance = random.Random(seed)
    rates: list[tuple[float, ...]] = [(0.0, 0.0, 0.0, 0.0)]
    v_c = w_c = 0.0
    for k in range(1500):
        if k % 100 == 0:
            v_c, w_c = chance.uniform(-0.4, 0.4), chance.uniform(-0.4, 0.4)
        state = robot.read(k * DT)
        done = controller.decide(state, push(v_c, w_c), DT)
        robot.write(done.base, done.joints, None, k * DT, k * DT)
        rates.append((done.split.v_b, done.split.w_b, *done.joints))
        for angle, joint in zip(state.q, each[2:], strict=True):
            assert joint.lower - 1e-3 <= angle <= joint.upper + 1e-3
    for before, after in pairwise(rates):
        for was, is_, channel in zip(before, after, each, strict=True):
            assert abs(is_) <= channel.rate_max * (1 + 1e-6)
            assert abs(is_ - was) <= channel.change_max * DT * (1 + 1e-6)


def test_limits_keep_the_hands_direction() -> None:
    """Where a limit slows the hand, it still goes where it was sent: the command is scaled, never one part of it."""
    slow = planar(arm=msgspec.structs.replace(planar().arm, dtheta_max=(0.3, 0.3)))
    robot = KinematicRobot(slow, psi=0.2)
    controller = HandController(slow, Exact())
    start = robot.read(0.0)
    heading = controller.locate(start).theta_e
    places = []
    scaled = False
    for k in range(2000):
        done = controller.decide(robot.read(k * DT), push(0.4, 0.0), DT)
        robot.write(done.base, done.joints, None, k * DT, k * DT)
        scaled = scaled or (done.scale < 0.9 and done.verdict is Verdict.SPEED)
        state = robot.true
        turn = state.theta_b + state.q[0]
        x = state.x_b + 0.5 * math.cos(turn) + 0.5 * math.cos(turn + state.q[1])
        y = state.y_b + 0.5 * math.sin(turn) + 0.5 * math.sin(turn + state.q[1])
        places.append((x, y))
    assert scaled
    x0, y0 = places[0]
    away = max(abs((y - y0) * math.cos(heading) - (x - x0) * math.sin(heading)) for x, y in places)
    assert math.dist(places[0], places[-1]) > 2.0
    assert away < 2e-3


def test_joint_limit_brakes_and_backs_out() -> None:
    """At a joint's limit the hand stops without passing it, says why, and can go back."""
    tight = planar(
        arm=msgspec.structs.replace(planar().arm, theta_min=(-4.8, 1.2), theta_max=(4.8, 2.5)),
        workspace=Workspace(0.5, 0.95, -0.6, 0.6),
    )
    robot = KinematicRobot(tight, l=0.7)
    controller = HandController(tight, Exact(Step()))
    verdicts = set()
    for k in range(600):
        done = controller.decide(robot.read(k * DT), push(0.3, 0.0), DT)
        robot.write(done.base, done.joints, None, k * DT, k * DT)
        verdicts.add(done.verdict)
        assert robot.true.q[1] >= 1.2 - 1e-3
    assert Verdict.JOINT_LIMIT in verdicts
    stuck = robot.true.q[1]
    assert stuck == pytest.approx(1.2, abs=0.02)
    for k in range(600, 900):
        done = controller.decide(robot.read(k * DT), push(-0.3, 0.0), DT)
        robot.write(done.base, done.joints, None, k * DT, k * DT)
    assert robot.true.q[1] > stuck + 0.3


@given(speeds, speeds)
def test_at_rest_nothing_moves(v_c: float, w_c: float) -> None:
    """A zero command gives zero rates, in every frame and pose, also just after another command."""
    robot = KinematicRobot()
    for frame in Frame:
        controller = LawAlone(robot.model, Exact())
        controller.decide(robot.read(0.0), push(v_c, w_c), DT, frame=frame)
        controller.restart()
        done = controller.decide(robot.read(0.0), push(0.0, 0.0), DT, frame=frame)
        assert (done.split.v_b, done.split.w_b, *done.joints) == (0.0, 0.0, 0.0, 0.0)


def test_changing_the_frame_starts_the_heading_anew() -> None:
    """The hand's heading turns at w_c, stays over a change of law, and begins at its bearing with a change of frame."""
    robot = KinematicRobot(psi=0.3)
    controller = LawAlone(robot.model, Exact())
    assert controller.locate(robot.true).theta_e == pytest.approx(0.3)
    for _ in range(100):
        controller.decide(robot.true, push(0.0, 0.4), DT)
    assert controller.locate(robot.true).theta_e == pytest.approx(0.5)
    controller.configure(Paper())
    assert controller.locate(robot.true).theta_e == pytest.approx(0.5)
    controller.decide(robot.true, push(0.0), DT, frame=Frame.POLAR)
    controller.decide(robot.true, push(0.0), DT, frame=Frame.HAND)
    assert controller.locate(robot.true).theta_e == pytest.approx(0.3)


def test_inside_the_workspace_only_the_arm_moves() -> None:
    """A reach of 10 cm inside the workspace moves the base by nothing at all."""
    robot = KinematicRobot()
    controller = HandController(robot.model, Exact())
    for k in range(100):
        done = controller.decide(robot.read(k * DT), push(0.2, 0.0), DT)
        robot.write(done.base, done.joints, None, k * DT, k * DT)
    state = robot.read(0.5)
    assert (state.x_b, state.y_b, state.theta_b) == (0.0, 0.0, 0.0)
    assert state.q != inverse(0.65, 0.0, 0.5, 0.5, 1)


def test_a_joint_law_that_closes_the_residual_does() -> None:
    """To the joint rates of a law that says it closes the residual, what the base does otherwise is added."""
    law = Closing()
    robot = KinematicRobot(psi=0.3)
    hand = HandController(robot.model, law)
    for k in range(200):
        state = robot.read(k * DT)
        slipping = put(put(state, "v_b", state.v_b + 0.05), "w_b", state.w_b - 0.1) if k > 100 else state
        step = hand.decide(slipping, push(0.2, 0.05, Frame.WORLD), DT, k * DT, frame=Frame.WORLD)
        robot.write(step.base, step.joints, None, k * DT, k * DT)
    assert step.scale == 1.0
    mount = (0.0, 0.0, 0.0)
    slip_v, slip_w = step.base.v_x + 0.05, step.base.w_z - 0.1
    u_r, u_t = ee_velocity(step.polar.l, step.polar.psi, slip_v, slip_w, step.split.v_m, step.split.w_m, mount)
    assert (u_r, u_t) == pytest.approx((step.u.u_r, step.u.u_t), abs=1e-9)
