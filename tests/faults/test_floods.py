"""Too much of everything between operator and robot side: messages, connections, peers that read nothing."""

from __future__ import annotations

import contextlib
import json
import os
import socket
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

import pytest

from overreach.link.messages import Accepted
from overreach.link.operator_end import OperatorEnd
from overreach.requests import ResetRequest, StopRequest
from tests.processes import GENEROUS_S, Driver, Observer, port_of, robot, until
from tests.reached import Reached

pytestmark = pytest.mark.real_time

NOISE_S = 0.1
"""A busy machine may be this late [s]."""


def stopped(observer: Observer) -> float:
    """Ask for a stop; return how long it took until it was in force."""
    begun = time.monotonic()
    assert observer.link.request(StopRequest()) == Accepted()
    until(lambda: observer.now.stopped, what="the stop")
    return next(s.t for s in list(observer.states) if s.t > begun - 0.02 and s.stopped) - begun


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


class Drive(NamedTuple):
    """Second by second, p99 and maximum of the time between writes beyond a period [ms]; the part in which it moved.

    paused: how often the loop was held up so long that the robot came to rest by itself, and was armed again.
    """

    p99: list[float]
    most: list[float]
    moved: float
    paused: int


def apart(observer: Observer, driver: Driver, seconds: float) -> Drive:
    """Drive, and press again where a starved operator's commands were too far apart, or the robot had come to rest."""
    begun = observer.now.t
    end, moved, looks, paused = time.monotonic() + seconds, 0, 0, 0
    while time.monotonic() < end:
        driver.drive(0.1)
        looks += 1
        moved += observer.speed() > 0.0
        if observer.now.verdict in ("regrip", "lost"):
            driver.send(held=False)
            driver.grip += 1
        elif observer.now.verdict == "paused":
            paused += 1
            driver.send(held=False)
            driver.arm()
    told = [(s.apart_p99 / 1e3, s.apart_max / 1e3) for s in list(observer.states) if s.t > begun]
    each = [one for one, before in zip(told[1:], told, strict=False) if one != before]
    return Drive([p99 for p99, _ in each], [most for _, most in each], moved / looks, paused)


def again(driver: Driver) -> None:
    """Reset, arm, and press anew."""
    assert driver.link.request(ResetRequest()) == Accepted()
    driver.send(held=False)
    driver.arm()


@pytest.mark.parametrize("what", ["disarm", "stop", "hello", "command", "garbage"])
def test_floods(what: str, reached: Reached) -> None:
    """4 processes, 3,000 messages a second each: writes stay in time, Reset and Stop are answered, nothing is armed."""
    seconds = reached.times(60) + 1.0
    with robot() as (endpoint, _, observer):
        driver = Driver(observer.link)
        driver.arm()
        driver.drive(1.0)
        if what == "stop":
            observer.link.request(StopRequest())
        alone = apart(observer, driver, 2.0).most
        with flood(endpoint, what, seconds + 2.0):
            driver.drive(1.0)
            bare = [sys.executable, "-m", "tests.faults.beside", str(seconds)]
            with subprocess.Popen(bare, stdout=subprocess.PIPE, text=True) as beside:
                p99, most, moved, paused = apart(observer, driver, seconds)
                machine_p99, machine_most = zip(*json.loads(beside.communicate()[0]), strict=True)
            assert moved > 0.5 or what == "stop"  # nobody's messages crowd out those of who drives
            took = []
            for _ in range(5):
                begun = time.monotonic()
                assert observer.link.request(ResetRequest()) == Accepted()
                took.append(time.monotonic() - begun)
            stop = stopped(observer)
        # What the machine withholds from a bare loop at the same time is not of the flood's doing.
        assert statistics.median(p99) < 2.0 + statistics.median(machine_p99)
        assert statistics.median(most) < 10.0 + statistics.median(machine_most)
        assert max(took) < 1.0
        assert stop < 0.3 + NOISE_S
        again(driver)
        driver.drive(0.5)
        assert observer.speed() > 0.3
        sooner = sum(one <= 2.0 for one in most)
        reached.say(
            "floods of requests, connections, frames",
            f"4 x 3,000 {what} a second: between writes {statistics.median(p99):.2f} ms more than a period (p99), "
            f"{max(most):.1f} ms at most, within 2 ms in {sooner} of {len(most)} s (a bare loop beside it: "
            f"{max(machine_most):.1f} ms late at most; without a flood, {max(alone):.1f} ms), {paused} pauses; "
            f"Reset answered in {max(took) * 1e3:.0f} ms, Stop in force after {max(0.0, stop) * 1e3:.0f} ms",
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
            stop = stopped(observer)
        finally:
            operator.close()
    assert came < 5.0
    assert stop < 0.3 + NOISE_S
    kind = "silent" if not begin else "half-open"
    reached.say(
        "floods of requests, connections, frames",
        f"300 {kind} connections: an operator is in after {came:.1f} s, Stop after {max(0.0, stop) * 1e3:.0f} ms",
    )


def test_a_full_table_of_connections(reached: Reached) -> None:
    """More connections than are taken: who is connected drives on, and a Stop on an open connection is not delayed."""
    with robot() as (endpoint, _, observer):
        driver = Driver(observer.link)
        driver.arm()
        with idle(port_of(endpoint), 1100):
            driver.drive(0.5)
            assert observer.speed() > 0.3
            stop = stopped(observer)
    assert stop < 0.3 + NOISE_S
    reached.say(
        "floods of requests, connections, frames",
        f"1,100 connections: a Stop on an open one in force after {max(0.0, stop) * 1e3:.0f} ms",
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
                p99, _, moved, _ = apart(observer, driver, 4.0)
                assert statistics.median(p99) < 2.0
                assert moved > 0.5
                assert observer.link.request(StopRequest()) == Accepted()
            finally:
                peer.kill()
