"""The pilot is a function of its inputs: what was recorded, played through a new one, gives the same bits."""

from __future__ import annotations

import math
import random
from typing import Any

import msgspec
import pytest

from overreach.arm.mount import Mount
from overreach.control.pilot import Pilot, replay
from overreach.control.tick import Tick
from overreach.errors import SetupError
from overreach.law.blend import Smoothstep, Step, Tanh
from overreach.law.body import WholeBody
from overreach.law.laws import Exact
from overreach.model.planar import planar
from overreach.model.workspace import Workspace
from overreach.plugs import law_names, load_law
from overreach.requests import ArmRequest, DisarmRequest, Request, ResetRequest, RestartRequest, StopRequest
from overreach.robots.imperfect import Imperfection
from overreach.robots.kinematic import KinematicRobot
from overreach.run.scenario import builtin_scenarios, load_scenario
from overreach.run.simulate import law_of, pilot_for, ticks
from overreach.types import Frame, RobotState, Twist
from overreach.verdicts import Motion, Verdict
from tests.said import push, said
from tests.serial import SerialRobot, six

DT = 0.005
ME = 7


def bits(tick: Tick) -> bytes:
    """Return all of a tick as bytes: -0.0 is not 0.0, and one nan is another."""
    return msgspec.msgpack.encode(tick, enc_hook=repr)


@pytest.mark.parametrize("name", sorted(builtin_scenarios()))
@pytest.mark.parametrize("law", law_names(planar()))
def test_a_recorded_scenario_replays_bit_for_bit(name: str, law: str) -> None:
    """Every built-in scenario: the recorded inputs through a new pilot give the same ticks, to the last bit.

    The whole of it with `exact`; the first second with each of the others.
    """
    scenario = load_scenario(name)
    if law != "exact":
        scenario = msgspec.structs.replace(scenario, duration=min(scenario.duration, 1.0))
    pilot = pilot_for(scenario, law_of(scenario, law))
    done = 0
    for tick, _ in ticks(scenario, law_of(scenario, law)):
        again = next(replay(pilot, [tick]))
        assert again == tick
        if tick.command is None or tick.command.seq % 10 == 1 or tick.gated.motion is Motion.NONE:
            assert bits(again) == bits(tick)  # -0.0 equals 0.0, but is not it
        done += 1
    assert done == scenario.steps


def stream(seed: int) -> tuple[list[Tick], WholeBody]:
    """Return a second or so of anything an operator, a robot and a network may do, as ticks."""
    chance = random.Random(seed)
    blend: Any = chance.choice([Smoothstep(), Tanh(), Step()])
    law = load_law(chance.choice(law_names(planar())), None, blend)
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
        if chance.random() < 0.01:
            other = load_law(chance.choice(law_names(planar())), None, blend)
            pilot.configure(other, planar(workspace=Workspace(0.5, 0.8, -0.5, 0.5)), chance.choice([0.5, 1.0]))
        if chance.random() < 0.005:
            pilot.fail("why not")
        if k % 40 == 4:
            grip += 1
            frame = chance.choice(list(Frame))
            twist = Twist(*[chance.uniform(-0.6, 0.6) if n in (0, 1, 5) else 0.0 for n in range(6)])
        command = None
        if chance.random() < 0.8:
            seq += 1
            odd = chance.random() < 0.02
            sent = Twist(chance.choice([math.nan, math.inf, 1.0]), v_z=chance.choice([0.0, 0.1])) if odd else twist
            command = msgspec.structs.replace(
                said(ME, seq, grip, chance.random() < 0.97, 0.0, 0.0, frame, seen=now - chance.uniform(0.0, 0.41)),
                twist=sent,
            )
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
    command = said(ME, 1, 1, True, 0.2, 0.1, seen=0.9)
    state = robot.read(1.0)
    tick = pilot.tick(state, command, 1.0, DT)
    assert (tick.state, tick.command, tick.requests, tick.now, tick.dt) == (state, command, (ArmRequest(ME),), 1.0, DT)
    assert pilot.tick(None, None, 1.0 + DT, DT).requests == ()


def driven(frame: Frame = Frame.HAND, v_c: float = 0.3) -> tuple[Pilot, KinematicRobot, float]:
    """Return a pilot in motion, its robot and the time."""
    pilot, robot, now = Pilot(planar(), Exact()), KinematicRobot(now=10.0), 10.0
    pilot.ask(ArmRequest(ME), now)
    for k in range(100):
        tick = pilot.tick(robot.read(now), said(ME, k + 1, 1, True, v_c, 0.0, frame, seen=now), now, DT)
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
        tick = pilot.tick(robot.read(now), said(ME, 101 + k, grip, True, 0.0, 0.3, Frame.WORLD, seen=now), now, DT)
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
        sent = msgspec.structs.replace(command, seq=200 + k, seen=now)
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
    tick = pilot.tick(robot.read(now), said(ME, 200, 1, True, 0.3, 0.0, gripper=0.5, seen=now), now, DT)
    assert tick.sentence.startswith("It has no gripper.")
    assert tick.gripper is None


REPORTED = [
    ("pose", "z"), ("pose", "q_w"), ("pose", "q_x"), ("pose", "q_y"), ("pose", "q_z"), ("motion", "v_y"),
    ("motion", "v_z"), ("motion", "w_x"), ("motion", "w_y"), ("", "gripper"), ("", "delay"), ("", "ages"),
]  # fmt: skip


def altered(state: RobotState, part: str, field: str, value: Any) -> RobotState:
    if not part:
        return msgspec.structs.replace(state, **{field: (0.0, value) if field == "ages" else value})
    return msgspec.structs.replace(state, **{part: msgspec.structs.replace(getattr(state, part), **{field: value})})


@pytest.mark.parametrize(("part", "field"), REPORTED)
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, "text", None])
def test_no_number_of_a_state_may_be_none(part: str, field: str, bad: Any) -> None:
    """What is reported of height, attitude, rocking, gripper and ages is finite, or it is a FAULT and a ramp."""
    pilot, robot, now = driven()
    for _ in range(60):
        tick = pilot.tick(altered(robot.read(now), part, field, bad), None, now, DT)
        robot.write(tick.base, tick.joints, tick.gripper, now, now + DT)
        now += DT
        assert tick.verdict is Verdict.FAULT
    assert not any(tick.decided.rates)


@pytest.mark.parametrize(("part", "field"), REPORTED)
@pytest.mark.parametrize("value", [1e308, -0.9, 3.0])
def test_no_number_of_a_state_moves_a_robot_that_nobody_drives(part: str, field: str, value: float) -> None:
    """Whatever is reported there, a robot that is disarmed stands still."""
    pilot, robot, now = Pilot(planar()), KinematicRobot(now=10.0), 10.0
    for _ in range(100):
        tick = pilot.tick(altered(robot.read(now), part, field, value), None, now, DT)
        assert not any(tick.decided.rates)
        now += DT


@pytest.mark.parametrize("size", [0.0, 0.5, 2.0])
def test_an_attitude_that_is_none_is_a_fault(size: float) -> None:
    """A quaternion that is not of length 1 tells no attitude: FAULT."""
    pilot, robot, now = driven()
    state = robot.read(now)
    pose = msgspec.structs.replace(state.pose, q_w=size * state.pose.q_w, q_z=size * state.pose.q_z)
    tick = pilot.tick(msgspec.structs.replace(state, pose=pose), None, now, DT)
    assert tick.decided.fault == "The robot's feedback of the base's attitude is no unit quaternion."


def test_a_gripper_opens_from_0_to_1() -> None:
    """Where there is a gripper, what it is told lies in 0 to 1, and in a FAULT it is told nothing."""
    pilot, robot = Pilot(SerialRobot(six())), KinematicRobot(SerialRobot(six()))
    pilot.ask(ArmRequest(ME), 0.0)
    tick = pilot.tick(robot.read(0.0), said(ME, 1, 1, True, 0.0, 0.0, gripper=0.4, seen=0.0), 0.0, DT)
    assert tick.gripper == 0.4
    tick = pilot.tick(robot.read(DT), said(ME, 2, 1, True, 0.0, 0.0, gripper=1e9, seen=DT), DT, DT)
    assert (tick.gripper, tick.verdict) == (None, Verdict.NO_SUCH_MOTION)
    pilot.tick(robot.read(2 * DT), said(ME, 3, 1, True, 0.0, 0.0, gripper=0.4, seen=2 * DT), 2 * DT, DT)
    pilot.fail("why")
    tick = pilot.tick(robot.read(3 * DT), said(ME, 4, 1, True, 0.0, 0.0, gripper=0.4, seen=3 * DT), 3 * DT, DT)
    assert tick.gripper is None


def test_a_law_is_changed_for_the_same_robot() -> None:
    """Another workspace comes into force with a law; another mount is another robot, and is refused."""
    pilot = Pilot(planar())
    pilot.configure(Exact(), planar(workspace=Workspace(0.5, 0.8, -0.5, 0.5)))
    assert pilot.model.workspace.l_max == 0.8
    with pytest.raises(SetupError, match="the same robot"):
        pilot.configure(Exact(), planar(mount=Mount(0.1, 0.0, 0.0)))
    with pytest.raises(SetupError, match="speed scale"):
        pilot.configure(Exact(), planar(), 0.0)
    assert pilot.model.workspace.l_max == 0.8


def test_a_heading_that_is_left_out_is_that_of_the_quaternion() -> None:
    """A robot that reports an attitude alone is driven as one that reports its heading, too."""
    _, robot, now = driven()
    state = robot.read(now)
    bare = msgspec.structs.replace(state, pose=msgspec.structs.replace(state.pose, heading=None))
    told, derived = (Pilot(planar()).tick(one, None, now, DT).decided for one in (state, bare))
    assert derived.polar.theta_e == pytest.approx(told.polar.theta_e, abs=1e-12)
    assert derived.state.pose.yaw == pytest.approx(state.theta_b, abs=1e-12)
