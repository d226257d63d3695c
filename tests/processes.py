"""The real halves as real processes, and an observer who measures the robot from outside."""

from __future__ import annotations

import contextlib
import multiprocessing
import re
import signal
import socket
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import psutil

from overreach.link.endpoint import free_port
from overreach.link.messages import Accepted, State
from overreach.link.operator_end import OperatorEnd
from overreach.requests import ArmRequest
from tests.said import said

GENEROUS_S = 20.0
"""Deadline for anything that should take a second: two busy cores must not fail a test."""


def until(true: Callable[[], object], seconds: float = GENEROUS_S, what: str = "it") -> None:
    """Wait until `true()`; fail after `seconds`."""
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, f"{what} has not happened within {seconds} s"
        time.sleep(0.01)


def _names_a_robot(arguments: Sequence[str]) -> bool:
    """Say whether there is a word that is neither an option nor its value."""
    value = False
    for one in arguments:
        if one.startswith("--"):
            value = not one.startswith("--no-") and "=" not in one
        elif not value:
            return True
        else:
            value = False
    return False


class Half:
    """One `overreach` process; its robot is the planar one, if none is named."""

    def __init__(self, *arguments: str, env: dict[str, str] | None = None, begin: Sequence[str] = ()) -> None:
        if arguments[0] in ("drive", "robot") and not _names_a_robot(arguments[1:]):
            arguments = (arguments[0], "planar", *arguments[1:])
        self.process = subprocess.Popen(
            [*begin, sys.executable, "-m", "overreach", *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True, env=env,
        )  # fmt: skip

    @property
    def children(self) -> list[psutil.Process]:
        """The processes that it has started."""
        with contextlib.suppress(psutil.NoSuchProcess):
            return psutil.Process(self.process.pid).children(recursive=True)
        return []

    def url(self) -> str:
        """Wait for the page's address and return it."""
        assert self.process.stdout
        line = self.process.stdout.readline()
        found = re.search(r"http://\S+", line)
        assert found, f"no address in {line!r}; stderr: {self.process.stderr.read() if self.process.stderr else ''}"
        return found.group()

    def end(self, signal_number: int = signal.SIGTERM, seconds: float = GENEROUS_S) -> int:
        """Send a signal, wait for the end, return the exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal_number)
        try:
            return self.process.wait(seconds)
        finally:
            self.process.kill()
            for stream in (self.process.stdout, self.process.stderr):
                if stream:
                    stream.close()


@contextmanager
def half(*arguments: str, env: dict[str, str] | None = None, begin: Sequence[str] = ()) -> Iterator[Half]:
    """Run one process for the length of the block. begin: of its command line, as `ip netns exec`."""
    running = Half(*arguments, env=env, begin=begin)
    try:
        yield running
    finally:
        running.end()


class Observer:
    """Listens to the robot side by a connection of its own. State times are CLOCK_MONOTONIC's, as are ours."""

    def __init__(self, endpoint: str) -> None:
        self.link = OperatorEnd(endpoint)
        self.welcome = self.link.welcome(GENEROUS_S)
        self.states: deque[State] = deque(maxlen=20_000)
        self.link.subscribe(self.states.append)
        until(lambda: self.states, what="a first state")

    @property
    def now(self) -> State:
        """The newest state."""
        return self.states[-1]

    def speed(self, state: State | None = None) -> float:
        """Return the greatest of the four rates' sizes."""
        s = state or self.now
        return max(abs(s.base.v_x), abs(s.base.w_z), abs(s.v_m), abs(s.w_m))

    def stop_time(self, since: float) -> float:
        """Wait until the robot stands still; return how long after `since` it did, by the robot's clock."""
        until(lambda: self.now.t > since and self.speed() == 0.0, what="standstill")
        moving = [s.t for s in list(self.states) if self.speed(s) > 0.0]
        return max(moving, default=since) - since

    def close(self) -> None:
        self.link.close()


@contextmanager
def robot(*arguments: str, env: dict[str, str] | None = None) -> Iterator[tuple[str, Half, Observer]]:
    """Run a robot side; yield its endpoint, it, and an observer."""
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    with half("robot", "--listen", endpoint, *arguments, env=env) as running:
        observer = Observer(endpoint)
        try:
            yield endpoint, running, observer
        finally:
            observer.close()


class Driver:
    """An operator without a page: arms, presses, sends sticks."""

    def __init__(self, link: OperatorEnd, operator: int = 7) -> None:
        self.link = link
        self.operator = operator
        self.seq = 0
        self.grip = 0

    def arm(self) -> None:
        assert self.link.request(ArmRequest(self.operator)) == Accepted()
        self.grip += 1

    def send(self, v_c: float = 0.4, w_c: float = 0.0, held: bool = True) -> None:
        self.seq += 1
        self.link.send(said(self.operator, self.seq, self.grip, held, v_c, w_c, seen=self.link.t))

    def drive(self, seconds: float, v_c: float = 0.4, w_c: float = 0.0) -> None:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.send(v_c, w_c)
            time.sleep(1 / 60)


def drive_until(driver: Driver, observer: Observer, verdict: str) -> None:
    """Push forward until the robot side says `verdict`."""
    end = time.monotonic() + GENEROUS_S
    while observer.now.verdict != verdict:
        assert time.monotonic() < end, f"{observer.now.verdict}: {observer.now.sentence}"
        driver.send()
        time.sleep(1 / 60)


def to_full_speed(driver: Driver, observer: Observer) -> None:
    """Arm, and push forward until the base drives at full speed."""
    driver.arm()
    end = time.monotonic() + GENEROUS_S
    while observer.now.base.v_x <= 0.39:
        assert time.monotonic() < end, f"{observer.now.verdict}: {observer.now.sentence}"
        driver.drive(0.1)


def hog() -> None:
    """Use all of a core."""
    while True:
        pass


@contextmanager
def hogs(many: int) -> Iterator[None]:
    """Keep `many` cores busy."""
    running = [multiprocessing.get_context("spawn").Process(target=hog, daemon=True) for _ in range(many)]
    for process in running:
        process.start()
    try:
        yield
    finally:
        for process in running:
            process.kill()
            process.join()


def port_of(endpoint: str) -> int:
    """Return the port of an endpoint."""
    return int(endpoint.rsplit(":", 1)[1])


def port_is_free(port: int) -> bool:
    """Say whether nothing listens at the port."""
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) != 0


def gone(pid: int) -> bool:
    """Say whether the process has ended (a zombie has)."""
    try:
        return psutil.Process(pid).status() == psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return True
