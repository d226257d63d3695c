from __future__ import annotations

import contextlib
import os
import signal
import time
from collections.abc import Iterator

import psutil
import pytest

from overreach.clock import MonotonicClock
from overreach.errors import SetupError, UnknownNameError
from overreach.host.hosted import Hosted
from overreach.robots.base import RobotFault
from overreach.testing.robot import check_robot
from overreach.types import BaseTwist, Takeover
from tests.processes import gone, until

PERIOD_S = 0.005

pytestmark = pytest.mark.timed


@pytest.fixture
def hosted() -> Iterator[Hosted]:
    robot = Hosted("planar", PERIOD_S, MonotonicClock())
    try:
        yield robot
    finally:
        robot.close()


def read(robot: Hosted) -> None:
    """Wait for a first state."""

    def there() -> bool:
        with contextlib.suppress(RobotFault):
            robot.read(time.monotonic())
            return True
        return False

    until(there, what="a state")


@pytest.mark.real_time
def test_a_hosted_robot_conforms() -> None:
    """From outside it is a robot like any other, in real time, and its model is the robot's."""
    robots = []

    def make(_now: float) -> Hosted:
        robots.append(Hosted("planar", PERIOD_S, MonotonicClock()))
        read(robots[-1])
        return robots[-1]

    try:
        check_robot(make, MonotonicClock(), PERIOD_S, settles_s=0.2)
    finally:
        for robot in robots:
            robot.close()


def test_it_says_what_became_of_the_last_write(hosted: Hosted) -> None:
    """In time, nothing; past the deadline, the rates that stand; past 100 ms, that it is latched; armed, nothing."""
    read(hosted)
    rates = BaseTwist(0.3, 0.0, 0.5), (0.2, -0.4)

    def write() -> Takeover | None:
        now = time.monotonic()
        state = hosted.read(now)
        hosted.write(*rates, None, now, now + 2 * PERIOD_S)
        return state.takeover

    def for_a_while() -> list[Takeover | None]:
        told = []
        for _ in range(20):
            told.append(write())
            time.sleep(PERIOD_S)
        return told

    assert not any(for_a_while())
    time.sleep(0.04)
    found = hosted.read(time.monotonic()).takeover
    assert found is not None
    assert not found.latched
    part = found.rates[0] / 0.3
    assert 0.2 < part < 1.0
    assert found.rates == pytest.approx((0.3 * part, 0.5 * part, 0.2 * part, -0.4 * part))
    for_a_while()  # in a loop that does not look, the host itself keeps the accelerations
    assert not any(for_a_while())
    time.sleep(0.15)
    latched = for_a_while()
    assert all(one is not None and one.latched for one in latched)
    assert not any(rate for one in latched[-3:] if one for rate in one.rates)
    hosted.arm(time.monotonic())
    assert not any(one and one.latched for one in for_a_while())
    assert hosted.read(time.monotonic()).v_b == pytest.approx(0.3)


def test_what_its_loop_was_held_up_for_is_not_its_fault(hosted: Hosted) -> None:
    """Loop and host held up together: no fault; a host that is silent while the loop goes on is one within 100 ms."""
    read(hosted)
    os.kill(hosted.pid, signal.SIGSTOP)
    time.sleep(0.3)
    hosted.read(time.monotonic())
    os.kill(hosted.pid, signal.SIGCONT)
    time.sleep(0.05)
    hosted.read(time.monotonic())
    os.kill(hosted.pid, signal.SIGSTOP)
    since = time.monotonic()

    def looks() -> None:
        while True:
            hosted.read(time.monotonic())
            time.sleep(PERIOD_S)

    with pytest.raises(RobotFault, match="has not answered for"):
        looks()
    assert 0.05 < time.monotonic() - since < 0.2
    os.kill(hosted.pid, signal.SIGCONT)
    until(lambda: not _raises(hosted), what="its return")


def _raises(robot: Hosted) -> bool:
    try:
        robot.read(time.monotonic())
    except RobotFault:
        return True
    return False


def test_a_host_that_hangs_is_ended_with_its_loop() -> None:
    """Closing does not wait for a host that hangs for longer than 2 s: it is gone then."""
    robot = Hosted("planar", PERIOD_S, MonotonicClock())
    host = psutil.Process(robot.pid)
    host.suspend()
    begun = time.monotonic()
    robot.close()
    assert time.monotonic() - begun < 3.0
    assert gone(host.pid)


def test_robots_that_nobody_knows_or_waits_for() -> None:
    """A name that nothing answers to, and a wait that is given up, are set-up errors; no process is left."""
    before = psutil.Process().children()
    with pytest.raises(SetupError, match="unknown robot 'nobody'"):
        Hosted("nobody", PERIOD_S, MonotonicClock())
    with pytest.raises(SetupError, match="not waited for"):
        Hosted("planar", PERIOD_S, MonotonicClock(), lambda: True)
    assert psutil.Process().children() == before
    assert issubclass(UnknownNameError, SetupError)
