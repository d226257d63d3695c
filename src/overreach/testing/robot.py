"""What every robot must satisfy, real or simulated. In a test of your own: `check_robot(lambda now: MyRobot(now))`."""

from __future__ import annotations

import math
from collections.abc import Callable

from overreach.clock import Clock, SteppedClock
from overreach.model.model import channels
from overreach.robots.base import Robot
from overreach.types import FLOATS, BaseTwist, RobotState

PARTS = ("model", "simulated", "read", "write", "arm", "stop", "restart")
PERIOD = 0.01
"""Robots are read and written with this period [s]."""
PART = 0.1
"""Each channel is asked for this fraction of its greatest rate."""
SETTLES_S = 1.0
"""After this long [s], a rate that is asked for is reached, and one that is not has come to zero ..."""
TOLERANCE = 0.3
"""... to within this fraction of what was asked for."""
STILL = 1e-3
"""A robot at rest moves by no more than this [m/s, rad/s]."""
UNIT = 1e-3
"""How close the length of the attitude's quaternion must be to 1."""


def check_robot(
    make: Callable[[float], Robot], clock: Clock | None = None, period: float = PERIOD, settles_s: float = SETTLES_S
) -> None:
    """Raise AssertionError if a robot from `make(now)` breaks a promise. The robot moves, one channel at a time.

    clock: a real one for a robot that runs in real time; else time is stepped. Checked: it has all that the Protocol
    names; states have the model's joints, finite numbers in Python's own floats, a unit quaternion, and a stamp that is
    not ahead and that advances; at first it is at rest; each channel that is asked for moves, the others do not, and
    its position follows the sign of its rate; a request holds until the next one; `stop` brings it to rest; and a
    simulated robot goes back to its start.
    """
    clock = clock or SteppedClock(1000.0)
    robot = make(clock.now())
    missing = [name for name in PARTS if not hasattr(robot, name)]
    assert not missing, f"robot lacks {', '.join(missing)}"
    each = channels(robot.model)
    assert len({channel.name for channel in each}) == len(each), "two channels have one name"
    first = _read(robot, clock, None)
    robot.arm(clock.now())
    assert max(map(abs, _rates(robot, first)), default=0.0) <= STILL, f"moves before it is asked to: {first}"
    last = first
    for k, channel in enumerate(each):
        for sign in (1.0, -1.0):
            wanted = [0.0] * len(each)
            wanted[k] = sign * PART * channel.rate_max
            begin = _positions(robot, last)[k]
            last = _drive(robot, clock, wanted, period, settles_s, last)
            _check_rates(robot, last, wanted, [one.name for one in each])
            way = _positions(robot, last)[k] - begin
            assert way * sign > 0.0, f"{channel.moves} goes the wrong way: {way:+.3g} at {wanted[k]:+.3g}"
            # A request holds: for one more period nothing is written.
            clock.sleep_until(clock.now() + period)
            last = _read(robot, clock, last)
            _check_rates(robot, last, wanted, [one.name for one in each])
            last = _drive(robot, clock, [0.0] * len(each), period, settles_s, last)
            assert max(map(abs, _rates(robot, last))) <= STILL, f"{channel.name} does not come to rest: {last}"
    _drive(robot, clock, [0.5 * PART * channel.rate_max for channel in each], period, settles_s, last)
    robot.stop(clock.now())
    clock.sleep_until(clock.now() + settles_s)
    last = _read(robot, clock, last)
    assert max(map(abs, _rates(robot, last))) <= STILL, f"moves after stop: {last}"
    if robot.simulated:
        robot.restart(clock.now())
        again = _read(robot, clock, None)
        off = max(abs(a - b) for a, b in zip(_positions(robot, again), _positions(robot, first), strict=True))
        assert off <= STILL, f"restart is {off:.2g} off the start"


def _read(robot: Robot, clock: Clock, before: RobotState | None) -> RobotState:
    now = clock.now()
    state = robot.read(now)
    n = len(robot.model.arm.channels)
    assert len(state.q) == len(state.dq) == n, f"reports {len(state.q)} joints and {len(state.dq)} rates, has {n}"
    own = set(map(type, (*state.numbers, *state.q, *state.dq))) == FLOATS and type(state.q) is type(state.dq) is tuple
    assert own, f"reports numbers that are not Python's own floats, in tuples: {state}"
    assert all(map(math.isfinite, (*state.numbers, *state.q, *state.dq))), f"reports what is not finite: {state}"
    pose = state.pose
    length = math.hypot(pose.q_w, pose.q_x, pose.q_y, pose.q_z)
    assert abs(length - 1.0) <= UNIT, f"the attitude is no unit quaternion: its length is {length:.6g}"
    assert state.t <= now, f"the stamp {state.t:g} s is ahead of the clock, {now:g} s"
    if before is not None:
        assert state.t > before.t, f"the stamp does not go on: {state.t:g} s after {before.t:g} s"
    return state


def _positions(robot: Robot, state: RobotState) -> tuple[float, ...]:
    """Return what each channel moves; for the base's place, its distance along the heading, and to its left."""
    pose = state.pose
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    where = BaseTwist(pose.x * c + pose.y * s, pose.y * c - pose.x * s, pose.yaw)
    return *robot.model.base.rates(where), *state.q


def _rates(robot: Robot, state: RobotState) -> tuple[float, ...]:
    motion = state.motion
    return *robot.model.base.rates(BaseTwist(motion.v_x, motion.v_y, motion.w_z)), *state.dq


def _drive(
    robot: Robot, clock: Clock, wanted: list[float], period: float, seconds: float, last: RobotState
) -> RobotState:
    for _ in range(max(1, round(seconds / period))):
        now = clock.now()
        base = robot.model.base
        robot.write(base.twist(tuple(wanted)), tuple(wanted[base.axes :]), None, now, now + 2.0 * period)
        clock.sleep_until(now + period)
        last = _read(robot, clock, last)
    return last


def _check_rates(robot: Robot, state: RobotState, wanted: list[float], names: list[str]) -> None:
    most = max(map(abs, wanted))
    for name, rate, asked in zip(names, _rates(robot, state), wanted, strict=True):
        off = abs(rate - asked)
        assert off <= TOLERANCE * most + STILL, f"{name} is {rate:.3g}, {asked:.3g} was asked for"
