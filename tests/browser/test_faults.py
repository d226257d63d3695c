"""Faults that the page must tell of, or must not let in."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import psutil
import pytest
from playwright.sync_api import BrowserContext
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.typing import Origin

from tests.browser.conftest import Cockpit
from tests.browser.hands import arm
from tests.browser.upgrade import upgrade
from tests.processes import until
from tests.reached import Reached

pytestmark = [pytest.mark.browser, pytest.mark.real_time]


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP])
def test_the_page_says_that_the_robots_host_is_gone(
    context: BrowserContext, fresh_cockpit: Cockpit, how: signal.Signals
) -> None:
    """A robot's host that dies or hangs while one drives: Fault, and what it is, on the page."""
    cockpit = fresh_cockpit
    page = cockpit.watch(context.new_page())
    arm(page, cockpit.observer)
    page.keyboard.down("ArrowUp")
    until(lambda: cockpit.observer.speed() > 0.3, what="motion")
    host = next(child for child in cockpit.robot.children if "overreach.host" in child.cmdline())
    os.kill(host.pid, how)
    until(lambda: page.inner_text("#verdict-word") == "Fault", what="the word")
    what = "has not answered" if how is signal.SIGSTOP else "has ended (signal 9)"
    assert page.inner_text("#verdict-reason").startswith(f"The robot's host {what}")
    page.keyboard.up("ArrowUp")
    if how is signal.SIGSTOP:
        os.kill(host.pid, signal.SIGCONT)


def test_the_page_says_that_the_robot_side_was_held_up(context: BrowserContext, fresh_cockpit: Cockpit) -> None:
    """A robot side that was paused while one drives: disarmed, with the reason; Arm and a new press go on."""
    cockpit = fresh_cockpit
    page = cockpit.watch(context.new_page())
    arm(page, cockpit.observer)
    page.keyboard.down("ArrowUp")
    until(lambda: cockpit.observer.speed() > 0.39, what="full speed")
    cockpit.robot.process.send_signal(signal.SIGSTOP)
    page.wait_for_timeout(300)
    cockpit.robot.process.send_signal(signal.SIGCONT)
    until(lambda: "held up" in page.inner_text("#verdict-reason"), what="the words")
    assert page.inner_text("#verdict-word") == "Disarmed"
    page.wait_for_timeout(300)
    assert cockpit.observer.speed() == 0.0
    page.keyboard.up("ArrowUp")
    arm(page, cockpit.observer)
    page.keyboard.down("ArrowUp")
    until(lambda: cockpit.observer.speed() > 0.3, what="motion")
    page.keyboard.up("ArrowUp")


def memory(process: psutil.Process) -> float:
    """Return what it holds and no other process does [MiB]."""
    return float(process.memory_full_info().uss) / 2**20


def test_frames_that_are_too_long(fresh_cockpit: Cockpit, reached: Reached) -> None:
    """A frame beyond the limit ends its connection with 1009, and the cockpit does not grow."""
    address = fresh_cockpit.url.replace("http", "ws") + "/ws"
    process, times = psutil.Process(fresh_cockpit.half.process.pid), reached.times(200)

    def send(size: int) -> int:
        with connect(address, origin=Origin(fresh_cockpit.url)) as socket:
            socket.send("x" * size)
            try:
                while True:
                    socket.recv(10.0)
            except ConnectionClosed as closed:
                return closed.rcvd.code if closed.rcvd else 0

    codes = [send(100_000) for _ in range(3)]
    before = memory(process)
    codes += [send(1_000_000) for _ in range(times)]
    grown = memory(process) - before
    assert set(codes) == {1009}
    assert grown < 2.0
    reached.say("oversized frame", f"{times} frames of 1 MB: closed with 1009, {max(0.0, grown):.1f} MiB more memory")


def test_strangers(shared_cockpit: Cockpit, reached: Reached) -> None:
    """Pages of other sites, and this one under foreign names: none of 20 ways in is let in."""
    own = shared_cockpit.url
    foreign = [
        "http://evil.example",
        "null",
        "https://127.0.0.1",
        own + ".evil.example",
        "http://localhost:1",
        "file://",
    ]
    ways = [{"Origin": origin} for origin in foreign]
    ways += [{"Origin": f"http://{host}", "Host": host} for host in ("evil.example", "127.0.0.1.evil.example", "x:1@y")]
    ways += [{}]
    paths = ("/ws", "/_nicegui_ws/socket.io/?transport=websocket&EIO=4")
    answers = [upgrade(own, way, path) for way in ways for path in paths]
    assert len(answers) == 20
    assert not any(answer == 101 for answer in answers), answers
    told = sum(answer == 101 for answer in answers)
    reached.say("foreign Origin, foreign Host", f"{told} of {len(answers)} accepted")


def test_no_file_is_left_in_shared_memory(fresh_cockpit: Cockpit) -> None:
    """What loop and host share has no name: nothing of it lies in a file system, however they end."""
    shared = Path("/dev/shm")
    before = set(shared.iterdir()) if shared.exists() else set()
    fresh_cockpit.robot.process.kill()
    fresh_cockpit.robot.process.wait()
    after = set(shared.iterdir()) if shared.exists() else set()
    assert after <= before
    assert not any("overreach" in path.name or "zenoh" in path.name for path in after)
