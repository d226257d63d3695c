"""The wire between operator and robot side at its worst: late, too narrow, flooded, full. Real halves, real sockets."""

from __future__ import annotations

import contextlib
import os
import random
import socket
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from overreach.link.messages import Accepted
from overreach.link.operator_end import OperatorEnd
from overreach.requests import ArmRequest, ResetRequest, StopRequest
from tests.narrow import Narrow, narrow
from tests.processes import GENEROUS_S, Driver, Observer, robot, until
from tests.reached import Reached

pytestmark = pytest.mark.real_time

BOUND_S = 0.4
LET_GO_S = 0.45
NOISE_S = 0.1
"""A busy machine may be this late [s]."""
STICKS_HZ = 60.0


def port_of(endpoint: str) -> int:
    return int(endpoint.rsplit(":", 1)[1])


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
    for delay in (0.1, 0.25, 0.5, 1.0, 2.0):
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


@contextmanager
def flood(endpoint: str, what: str, seconds: float, rate: float = 3000.0, many: int = 4) -> Iterator[None]:
    """Run processes that ask a robot side."""
    command = [sys.executable, "-m", "tests.faults.flood", endpoint, what, str(seconds), str(rate)]
    running = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(many)]
    try:
        yield
    finally:
        for process in running:
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(seconds + 10.0)
            process.kill()
            process.communicate()


def apart(observer: Observer, driver: Driver, seconds: float) -> tuple[list[float], list[float]]:
    """Drive; return, second by second, p99 and maximum of the time between writes beyond a period [ms]."""
    observer.states.clear()
    driver.drive(seconds)
    told = [(s.apart_p99 / 1e3, s.apart_max / 1e3) for s in list(observer.states)]
    each = [one for one, before in zip(told[1:], told, strict=False) if one != before]
    return [p99 for p99, _ in each], [most for _, most in each]


def again(driver: Driver) -> None:
    """Reset, arm, and press anew."""
    assert driver.link.request(ResetRequest()) == Accepted()
    driver.send(held=False)
    driver.arm()


@pytest.mark.parametrize("what", ["disarm", "stop", "hello", "command", "garbage"])
def test_floods(what: str, reached: Reached) -> None:
    """4 processes, 3,000 messages a second each: writes stay in time, Reset and Stop are answered, nothing is armed."""
    seconds = reached.times(60) + 2.0
    with robot() as (endpoint, _, observer):
        driver = Driver(observer.link)
        driver.arm()
        driver.drive(1.0)
        if what == "stop":
            observer.link.request(StopRequest())
        _, alone = apart(observer, driver, 3.0)
        with flood(endpoint, what, seconds + 4.0):
            driver.drive(1.5)
            p99, most = apart(observer, driver, seconds)
            took = []
            for _ in range(10):
                begun = time.monotonic()
                assert observer.link.request(ResetRequest()) == Accepted()
                took.append(time.monotonic() - begun)
            begun = time.monotonic()
            assert observer.link.request(StopRequest()) == Accepted()
            stop = time.monotonic() - begun
        assert statistics.median(p99) < 2.0
        assert statistics.median(most) < 10.0
        assert max(took) < 1.0
        assert stop < 0.3 + NOISE_S
        again(driver)
        driver.drive(0.5)
        assert observer.speed() > 0.3
        sooner = sum(one <= 2.0 for one in most)
        reached.say(
            "floods of requests, connections, frames",
            f"4 x 3,000 {what} a second: writes {max(p99):.2f} ms late (p99), {max(most):.1f} ms at most "
            f"({sooner} of {len(most)} seconds within 2 ms; {max(alone):.1f} ms without a flood); "
            f"Reset answered in {max(took) * 1e3:.0f} ms, Stop in {stop * 1e3:.0f} ms",
        )


@contextmanager
def idle(port: int, many: int, begin: bytes = b"") -> Iterator[list[socket.socket]]:
    """Hold connections that say nothing, or begin to say something."""
    held: list[socket.socket] = []
    try:
        for _ in range(many):
            one = socket.socket()
            one.settimeout(5.0)
            held.append(one)
            with contextlib.suppress(OSError):
                one.connect(("127.0.0.1", port))
                one.sendall(begin)
        yield held
    finally:
        for one in held:
            one.close()


@pytest.mark.parametrize("begin", [b"", b"\x20\x00\x01"], ids=["silent", "half a message"])
def test_idle_connections(begin: bytes, reached: Reached) -> None:
    """300 connections that say nothing, or half of something, do not keep an operator out, nor delay a Stop."""
    with robot() as (endpoint, _, observer), idle(port_of(endpoint), 300, begin):
        begun = time.monotonic()
        operator = OperatorEnd(endpoint)
        try:
            operator.welcome(GENEROUS_S)
            came = time.monotonic() - begun
            operator.subscribe(lambda _: None)
            until(lambda: operator.t is not None, what="a state")
            driver = Driver(operator)
            driver.arm()
            driver.drive(0.5)
            assert observer.speed() > 0.3
            begun = time.monotonic()
            assert observer.link.request(StopRequest()) == Accepted()
            stop = time.monotonic() - begun
        finally:
            operator.close()
    assert came < 5.0
    assert stop < 0.3 + NOISE_S
    kind = "silent" if not begin else "half-open"
    reached.say(
        "floods of requests, connections, frames",
        f"300 {kind} connections: an operator is let in after {came:.1f} s, Stop answered in {stop * 1e3:.0f} ms",
    )


def test_a_full_table_of_connections(reached: Reached) -> None:
    """More connections than are taken: who is connected drives on, and a Stop on an open connection is not delayed."""
    with robot() as (endpoint, _, observer):
        driver = Driver(observer.link)
        driver.arm()
        with idle(port_of(endpoint), 1100):
            driver.drive(0.5)
            assert observer.speed() > 0.3
            begun = time.monotonic()
            assert observer.link.request(StopRequest()) == Accepted()
            stop = time.monotonic() - begun
    assert stop < 0.3 + NOISE_S
    reached.say(
        "floods of requests, connections, frames",
        f"1,100 connections: Stop on an open one answered in {stop * 1e3:.0f} ms",
    )


def test_who_is_not_reading_holds_nobody_up() -> None:
    """A peer that asks, is suspended and reads nothing more: the loop writes on, and others are answered."""
    with robot() as (endpoint, _, observer):
        driver = Driver(observer.link)
        driver.arm()
        driver.drive(0.5)
        command = [sys.executable, "-m", "tests.faults.flood", endpoint, "hello", "30", "3000"]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL) as peer:
            driver.drive(1.5)
            os.kill(peer.pid, 19)  # SIGSTOP
            try:
                p99, _ = apart(observer, driver, 4.0)
                assert statistics.median(p99) < 2.0
                assert observer.speed() > 0.3
                assert observer.link.request(StopRequest()) == Accepted()
            finally:
                peer.kill()
