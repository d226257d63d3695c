"""What is left when halves end, in every way that they end: nothing."""

from __future__ import annotations

import os
import signal
import time
import urllib.request
from pathlib import Path

import pytest

from overreach.link.endpoint import free_port
from tests.processes import Driver, Half, gone, half, port_is_free, robot, until

pytestmark = pytest.mark.real_time


def ports_of(drive: Half, url: str) -> list[int]:
    """Return the ports of page and robot side."""
    command = drive.children[0].cmdline()
    endpoint = command[command.index("--listen") + 1]
    return [int(url.rsplit(":", 1)[1]), int(endpoint.rsplit(":", 1)[1])]


@pytest.mark.parametrize(
    ("who", "how", "code"),
    [
        ("operator", signal.SIGINT, 130),
        ("operator", signal.SIGTERM, 143),
        ("operator", signal.SIGKILL, -9),
        ("robot", signal.SIGINT, 2),
        ("robot", signal.SIGTERM, 2),
        ("robot", signal.SIGKILL, 2),
    ],
)
def test_drive_leaves_nothing_behind(who: str, how: signal.Signals, code: int, tmp_path: Path) -> None:
    """However either half of `drive` ends, the other ends too, and no process, port or file is left."""
    before = set(Path.cwd().iterdir())
    port = free_port()
    drive = Half("drive", "--no-browser", "--port", str(port))
    try:
        url = drive.url()
        with urllib.request.urlopen(url, timeout=10) as page:
            assert b"overreach" in page.read()
        robot_pid = drive.children[0].pid
        ports = ports_of(drive, url)
        os.kill(robot_pid if who == "robot" else drive.process.pid, how)
        assert drive.process.wait(20) == code
        if who == "robot":
            assert drive.process.stderr
            assert "robot side has ended" in drive.process.stderr.read()
        until(lambda: gone(robot_pid), what="the end of the robot side")
        until(lambda: all(port_is_free(one) for one in ports), what="free ports")
    finally:
        drive.end(signal.SIGKILL)
    assert set(Path.cwd().iterdir()) == before


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_robot_side_ends_in_order(how: signal.Signals) -> None:
    """A robot side that is told to end does so with exit code 0, though an operator is connected."""
    with robot() as (_, running, observer):
        Driver(observer.link).arm()
        assert running.end(how) == 0
        until(lambda: observer.now.verdict == "ending", what="the word of its end")


def test_cockpit_outlives_its_robot_side_and_finds_it_again() -> None:
    """On two machines, a robot side that restarts is found again by the cockpit that was there."""
    with robot() as (endpoint, running, _):
        with half("cockpit", "--connect", endpoint, "--no-browser", "--port", str(free_port())) as cockpit:
            url = cockpit.url()
            running.end(signal.SIGKILL)
            with urllib.request.urlopen(url, timeout=10) as page:
                assert page.status == 200
            with half("robot", "--listen", endpoint):
                time.sleep(1.0)
                assert cockpit.process.poll() is None


def test_two_drives_side_by_side() -> None:
    """A second `drive` finds a port of its own."""
    with half("drive", "--no-browser") as one, half("drive", "--no-browser") as two:
        assert one.url() != two.url()


def test_drive_with_a_taken_port_starts_nothing() -> None:
    """A page port that is taken is one line and exit code 2, and no robot side is left running."""
    with half("drive", "--no-browser", "--port", str(free_port())) as one:
        port = one.url().rsplit(":", 1)[1]
        with half("drive", "--no-browser", "--port", port) as two:
            assert two.process.wait(20) == 2
            assert two.process.stderr
            assert "choose another --port" in two.process.stderr.read()
            assert two.children == []
