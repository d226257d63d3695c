"""The pilot is a function of its inputs: what was recorded, played through a new one, gives the same bits."""

from __future__ import annotations

import math
import random
from typing import Any

import msgspec
import pytest

from overreach.control.pilot import Pilot, replay
from overreach.control.tick import Tick
from overreach.law.blend import Smoothstep, Step, Tanh
from overreach.law.body import WholeBody
from overreach.law.laws import Exact
from overreach.model.planar import planar
from overreach.plugs import law_names, load_law
from overreach.requests import ArmRequest, DisarmRequest, Request, ResetRequest, RestartRequest, StopRequest
from overreach.robots.imperfect import Imperfection
from overreach.robots.kinematic import KinematicRobot
from overreach.run.scenario import builtin_scenarios, load_scenario
from overreach.run.simulate import law_of, pilot_for, ticks
from overreach.types import Frame, RobotState, Twist
from overreach.verdicts import Motion, Verdict
from tests.said import push, said

DT = 0.005
ME = 7


def bits(tick: Tick) -> bytes:
    """Return all of a tick as bytes: -0.0 is not 0.0, and one nan is another."""
    return msgspec.msgpack.encode(tick, enc_hook=lambda value: value.name)


@pytest.mark.parametrize("name", sorted(builtin_scenarios()))
@pytest.mark.parametrize("law", ["exact", "qp"])
def test_a_recorded_scenario_replays_bit_for_bit(name: str, law: str) -> None:
    """Every built-in scenario: the recorded inputs through a new pilot give the same ticks, to the last bit."""
    scenario = load_scenario(name)
    scenario = msgspec.structs.replace(scenario, duration=min(scenario.duration, 2.0))
    done = [tick for tick, _ in ticks(scenario, law_of(scenario, law))]
    assert done[0].requests == (ArmRequest(1),)
    again = replay(pilot_for(scenario, law_of(scenario, law)), done)
    assert [bits(tick) for tick in again] == [bits(tick) for tick in done]


def stream(seed: int) -> tuple[list[Tick], WholeBody]:
    """Return a second or so of anything an operator, a robot and a network may do, as ticks."""
    chance = random.Random(seed)
    blend: Any = chance.choice([Smoothstep(), Tanh(), Step()])
    law = load_law(chance.choice(law_names()), None, blend)
    pilot = Pilot(planar(), law)
    now = chance.uniform(0.0, 1e5)
    imperfection = Imperfection(
        lag_s=chance.choice([0.0, 0.1]),
        noise=chance.choice([0.0, 1e-3]),
        seed=seed,
        feedback_s=chance.choice([0.0, 0.02]),
    )
    robot = KinematicRobot(imperfection=imperfection, now=now)
    made: list[Tick] = []
    seq = grip = 0
    frame, twist = Frame.HAND, push(0.0)
    for k in range(chance.randint(80, 240)):
        if k == 3 or chance.random() < 0.03:
            asked: list[Request] = [ArmRequest(ME, grip)]
            if k > 3:
                asked += [StopRequest(), ResetRequest(), DisarmRequest(chance.choice([ME, 9])), RestartRequest()]
            pilot.ask(chance.choice(asked), now)
        if k % 40 == 4:
            grip += 1
            frame = chance.choice(list(Frame))
            twist = Twist(*[chance.uniform(-0.6, 0.6) if n in (0, 1, 5) else 0.0 for n in range(6)])
        command = None
        if chance.random() < 0.8:
            seq += 1
            odd = chance.random() < 0.02
            sent = Twist(chance.choice([math.nan, math.inf, 1.0]), v_z=chance.choice([0.0, 0.1])) if odd else twist
            command = msgspec.structs.replace(said(ME, seq, grip, chance.random() < 0.97, 0.0, 0.0, frame), twist=sent)
        state: RobotState | None = robot.read(now)
        if chance.random() < 0.005:
            state = None
        tick = pilot.tick(state, command, now, DT)
        robot.write(tick.base, tick.joints, tick.gripper, now, now + DT)
        made.append(tick)
        now += DT * chance.choice([1.0, 1.0, 1.0, 1.3])
    return made, law


@pytest.mark.parametrize("part", range(10))
def test_random_streams_replay_bit_for_bit(part: int) -> None:
    """1,000 random streams of commands, requests and states, odd ones too, replay to the last bit."""
    moved = 0
    for seed in range(100 * part, 100 * part + 100):
        made, law = stream(seed)
        again = list(replay(Pilot(planar(), law), made))
        assert [bits(tick) for tick in again] == [bits(tick) for tick in made], seed
        moved += any(tick.base.v_x or any(tick.joints) for tick in made)
    assert moved > 40


def test_a_pilot_raises_nothing_and_keeps_what_it_was_told() -> None:
    """Each tick holds its inputs as they were given: state, command, requests, now and dt."""
    pilot, robot = Pilot(planar()), KinematicRobot()
    assert pilot.ask(ArmRequest(ME), 1.0) == ""
    command = said(ME, 1, 1, True, 0.2, 0.1)
    state = robot.read(1.0)
    tick = pilot.tick(state, command, 1.0, DT)
    assert (tick.state, tick.command, tick.requests, tick.now, tick.dt) == (state, command, (ArmRequest(ME),), 1.0, DT)
    assert pilot.tick(None, None, 1.0 + DT, DT).requests == ()


def driven(frame: Frame = Frame.HAND, v_c: float = 0.3) -> tuple[Pilot, KinematicRobot, float]:
    """Return a pilot in motion, its robot and the time."""
    pilot, robot, now = Pilot(planar(), Exact()), KinematicRobot(now=10.0), 10.0
    pilot.ask(ArmRequest(ME), now)
    for k in range(100):
        tick = pilot.tick(robot.read(now), said(ME, k + 1, 1, True, v_c, 0.0, frame), now, DT)
        robot.write(tick.base, tick.joints, None, now, now + DT)
        now += DT
    assert tick.verdict is Verdict.MOVING
    return pilot, robot, now


def test_what_a_stick_means_does_not_change_in_motion() -> None:
    """A command in another frame ramps to zero in the old one; only release and press drive in the new."""
    pilot, robot, now = driven()
    told = set()
    for k in range(200):
        grip = 1 if k < 150 else 2
        tick = pilot.tick(robot.read(now), said(ME, 101 + k, grip, True, 0.0, 0.3, Frame.WORLD), now, DT)
        robot.write(tick.base, tick.joints, None, now, now + DT)
        now += DT
        if k < 150:
            told.add(tick.verdict)
            assert tick.gated.twist.v_y == 0.0
            if tick.gated.motion is not Motion.NONE:
                assert tick.gated.frame is Frame.HAND
    assert told == {Verdict.REGRIP}
    assert tick.gated.frame is Frame.WORLD
    assert tick.gated.twist.v_y == pytest.approx(0.3)


@pytest.mark.parametrize("part", ["v_z", "w_x", "w_y"])
def test_a_motion_that_the_robot_lacks_is_refused_with_the_reason(part: str) -> None:
    """A command for a direction that the hand does not have moves nothing, says which, and is counted."""
    pilot, robot, now = driven()
    command = msgspec.structs.replace(said(ME, 200, 1, True, 0.3, 0.0), twist=Twist(v_x=0.3, **{part: 0.05}))
    refused = pilot.gate.refused
    for k in range(60):
        sent = msgspec.structs.replace(command, seq=200 + k)
        tick = pilot.tick(robot.read(now), sent, now, DT)
        robot.write(tick.base, tick.joints, None, now, now + DT)
        now += DT
    assert tick.verdict is Verdict.NO_SUCH_MOTION
    assert tick.sentence == f"It has no {part}. The robot's hand cannot move so."
    assert not any(tick.decided.rates)
    assert pilot.gate.refused == refused + 60


def test_a_gripper_that_is_not_there_is_refused() -> None:
    """A wish for the gripper of a robot without one is refused with the reason."""
    pilot, robot, now = driven()
    tick = pilot.tick(robot.read(now), said(ME, 200, 1, True, 0.3, 0.0, gripper=0.5), now, DT)
    assert tick.sentence.startswith("It has no gripper.")
    assert tick.gripper is None


@pytest.mark.parametrize(("part", "field"), [("pose", "z"), ("pose", "q_w"), ("pose", "q_x"), ("motion", "v_y"),
                                             ("motion", "w_x"), ("motion", "v_z")])  # fmt: skip
@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_no_number_of_a_state_may_be_none(part: str, field: str, bad: float) -> None:
    """What is reported of the base's height, attitude, rocking and sliding is finite, or it is a FAULT."""
    pilot, robot, now = driven()
    state = robot.read(now)
    wrong = msgspec.structs.replace(getattr(state, part), **{field: bad})
    tick = pilot.tick(msgspec.structs.replace(state, **{part: wrong}), None, now, DT)
    assert tick.verdict is Verdict.FAULT
    assert "not finite" in tick.decided.fault


def test_a_heading_that_is_left_out_is_that_of_the_quaternion() -> None:
    """A robot that reports an attitude alone is driven as one that reports its heading, too."""
    _, robot, now = driven()
    state = robot.read(now)
    bare = msgspec.structs.replace(state, pose=msgspec.structs.replace(state.pose, heading=None))
    told, derived = (Pilot(planar()).tick(one, None, now, DT).decided for one in (state, bare))
    assert derived.polar.theta_e == pytest.approx(told.polar.theta_e, abs=1e-12)
    assert derived.state.pose.yaw == pytest.approx(state.theta_b, abs=1e-12)
