"""The wire between operator and robot side at its worst: late, cut, too narrow. Real halves, real sockets."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from overreach.link.messages import Accepted
from overreach.link.operator_end import OperatorEnd
from overreach.requests import ArmRequest, StopRequest
from tests.narrow import Narrow, narrow
from tests.processes import GENEROUS_S, Driver, Observer, port_of, robot, until
from tests.reached import Reached

pytestmark = pytest.mark.timed

BOUND_S = 0.4
LET_GO_S = 0.45
NOISE_S = 0.1
"""A busy machine may be this late [s]."""
STICKS_HZ = 60.0


class Pushing:
    """A driver that pushes, 60 times a second, on a thread of its own, until it lets go."""

    def __init__(self, link: OperatorEnd, operator: int = 7) -> None:
        self.driver = Driver(link, operator)
        self.holds = True
        self._going = True
        self.driver.grip = 1
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while self._going:
            self.driver.send(held=self.holds)
            time.sleep(1.0 / STICKS_HZ)

    def let_go(self) -> float:
        """Let go; return when."""
        self.holds = False
        return time.monotonic()

    def press(self) -> None:
        self.driver.grip += 1
        self.holds = True

    def end(self) -> None:
        self._going = False
        self._thread.join()


@contextmanager
def far() -> Iterator[tuple[Narrow, OperatorEnd, Observer, Pushing]]:
    """A robot side, an observer next to it, and an operator who has armed and pushes through a link that can be bad."""
    with robot() as (endpoint, _, observer), narrow(port_of(endpoint)) as link:
        operator = OperatorEnd(f"tcp/127.0.0.1:{link.port}")
        try:
            operator.welcome(GENEROUS_S)
            operator.subscribe(lambda _: None)
            until(lambda: operator.t is not None, what="a state")
            assert operator.request(ArmRequest(7)) == Accepted()
            pushing = Pushing(operator)
            try:
                until(lambda: observer.speed() > 0.3, what="motion")
                yield link, operator, observer, pushing
            finally:
                pushing.end()
        finally:
            link.up.delay = link.down.delay = 0.0
            operator.close()


def rested(observer: Observer, since: float) -> float:
    """Return how long after `since` the robot stood still, by the robot's clock."""
    time.sleep(1.5)
    until(lambda: observer.speed() == 0.0, what="standstill")
    return max((s.t for s in list(observer.states) if observer.speed(s) > 0.0), default=since) - since


def test_a_constant_delay(reached: Reached) -> None:
    """Whatever the delay: at rest 0.45 s + the bound after letting go; beyond the bound, nothing is obeyed at all."""
    worst, told = 0.0, []
    for delay in (0.1, 0.25, 0.5, 1.0, 2.0) if reached.full else (0.25, 1.0):
        with far() as (link, _, observer, pushing):
            link.up.delay = delay
            time.sleep(delay + 1.5)
            moving = observer.speed() > 0.3
            if delay < 0.3:
                assert moving
            if delay > BOUND_S:
                assert observer.speed() == 0.0
                assert {s.verdict for s in list(observer.states)[-20:]} <= {"delayed", "lost"}
            if BOUND_S < delay < 2.0:  # a longer one looks like an end of the connection
                assert observer.now.sentence.startswith("A command was ")
            took = rested(observer, pushing.let_go())
            assert took < LET_GO_S + BOUND_S + NOISE_S
            worst = max(worst, took)
            told.append(f"{delay:g} s" + ("" if moving else " (not obeyed)"))
    reached.say(
        "constant or growing delay of the path",
        f"constant {', '.join(told)}: at rest {max(0.0, worst):.2f} s after letting go at most",
    )


def test_a_delay_that_comes_while_driving(reached: Reached) -> None:
    """The path becomes 2 s long at a random time, and the operator lets go at another: at rest in time."""
    rng, times, worst = random.Random(reached.seed), reached.times(20), 0.0
    for _ in range(times):
        with far() as (link, _, observer, pushing):
            time.sleep(rng.uniform(0.0, 0.3))
            link.up.delay = 2.0
            time.sleep(rng.uniform(0.0, 0.6))
            took = rested(observer, pushing.let_go())
            worst = max(worst, took)
            assert took < LET_GO_S + BOUND_S + NOISE_S
            time.sleep(2.5)
            assert observer.speed() == 0.0
    reached.say(
        "constant or growing delay of the path",
        f"2 s from one moment on, {times} times: at rest {max(0.0, worst):.2f} s after letting go at most",
    )


def test_a_path_too_narrow_for_the_sticks(reached: Reached) -> None:
    """20 % too narrow for the stream of sticks: let go of, at rest in time; Stop within 0.3 s, whatever is queued."""
    times, rests, stops = reached.times(20), [], []
    for _ in range(times):
        with far() as (link, operator, observer, pushing):
            passed, begun = link.up.passed, time.monotonic()
            time.sleep(2.0)
            link.up.rate = 0.8 * (link.up.passed - passed) / (time.monotonic() - begun)
            time.sleep(5.0)
            rests.append(rested(observer, pushing.let_go()))
            pushing.press()
            until(lambda: observer.speed() > 0.1, what="motion again")
            time.sleep(2.0)
            pressed = time.monotonic()
            assert operator.request(StopRequest()) == Accepted()
            until(lambda: observer.now.stopped, what="the stop")
            stopped = next(s.t for s in list(observer.states) if s.t > pressed - 0.01 and s.stopped)
            stops.append(stopped - pressed)
    assert max(rests) < LET_GO_S + BOUND_S + NOISE_S
    assert max(stops) < 0.3 + NOISE_S
    reached.say(
        "constant or growing delay of the path",
        f"20 % too narrow for the sticks, {times} times: at rest {max(rests):.2f} s after letting go at most, "
        f"Stop in force after {max(stops):.2f} s at most",
    )


def test_an_outage_and_the_first_press_after_it() -> None:
    """Let go while nothing comes through: after the outage nothing moves, and the first press counts."""
    with far() as (link, _, observer, pushing):
        link.up.cut = True
        time.sleep(0.5)
        pushing.let_go()
        time.sleep(1.5)
        assert observer.speed() == 0.0
        link.up.cut = False
        until(lambda: observer.now.verdict == "released", what="the release that was lost")
        assert observer.speed() == 0.0
        pushing.press()
        until(lambda: observer.speed() > 0.1, 2.0, what="motion at the first press")
