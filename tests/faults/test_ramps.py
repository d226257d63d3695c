"""The guard in real processes: plug-ins at their worst and every ordered end, seen by an observer at the robot."""

from __future__ import annotations

import signal
import time
from itertools import pairwise
from pathlib import Path

import msgspec
import pytest

from overreach.link.messages import Accepted, Choice, ConfigureRequest, Refused, State
from overreach.requests import ArmRequest, ResetRequest
from tests.plugin import install
from tests.processes import (
    Driver,
    Half,
    Observer,
    drive_until,
    half,
    port_is_free,
    port_of,
    robot,
    to_full_speed,
    until,
)
from tests.reached import Reached

pytestmark = pytest.mark.real_time

CHANGE = {"v_x": 3.5, "w_z": 12.0}
PERIOD_S = 0.005


def bounded(states: list[State]) -> None:
    """Assert that the base's rates keep their accelerations in the time, or the ticks, between states."""
    for before, after in pairwise(states):
        ticks = after.tick - before.tick
        for name, change in CHANGE.items():
            changed = abs(getattr(after.base, name) - getattr(before.base, name))
            passed = max(PERIOD_S * ticks, after.t - before.t)  # a held up loop finds what its host has ramped to
            assert changed <= change * passed * (1 + 1e-6) + 1e-12


def use(observer: Observer, law: str) -> None:
    settings = msgspec.structs.replace(observer.welcome.settings, law=Choice(law))
    assert observer.link.request(ConfigureRequest(settings)) == Accepted()


@pytest.mark.parametrize(
    ("law", "says"),
    [
        ("nan", "The law 'nan' answered v_b = nan. Press Reset, then Arm."),
        ("raises", "The law 'raises' raised ZeroDivisionError: a plug-in's own. Press Reset, then Arm."),
        ("nonsense", "The law 'nonsense' raised AttributeError"),
        ("hangs", "The law 'hangs' takes 3"),
    ],
)
def test_a_bad_law_while_driving(law: str, says: str, tmp_path: Path, reached: Reached) -> None:
    """A law that goes bad in motion: a ramp, FAULT with its reason; reset, another law, arm and a press go on."""
    with robot(env=install(tmp_path)) as (endpoint, running, observer):
        use(observer, law)
        driver = Driver(observer.link)
        driver.arm()
        drive_until(driver, observer, "fault")
        until(lambda: observer.speed() == 0.0, what="standstill")
        assert observer.now.sentence.startswith(says)
        assert (observer.now.stopped, observer.now.armed, observer.now.look) == (True, False, "stop")
        states = list(observer.states)
        assert max(state.base.v_x for state in states) > 0.2
        bounded(states)
        assert observer.link.request(ArmRequest(7, driver.grip)) == Refused("Fault: press Reset first.")
        use(observer, "exact")
        driver.drive(0.3)
        assert observer.speed() == 0.0
        assert observer.link.request(ResetRequest()) == Accepted()
        driver.drive(0.3)
        assert observer.speed() == 0.0
        driver.arm()
        driver.drive(0.5)
        assert observer.speed() > 0.3
        driver.send(held=False)
        assert running.end() == 0
        assert port_is_free(port_of(endpoint))
        reached.say(
            "plug-in raises, hangs, returns nonsense", f"law {law}: FAULT, a ramp, and on after Reset; 0 escapes"
        )


def coming_to_rest(observer: Observer, running: Half, how: signal.Signals, code: int) -> list[State]:
    """Send a signal while the robot drives; return the states from then on."""
    to_full_speed(Driver(observer.link), observer)
    since = observer.now.t
    assert running.end(how) == code
    until(lambda: observer.speed() == 0.0, what="standstill")
    return [state for state in list(observer.states) if state.t >= since]


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_every_ordered_end_is_a_ramp(how: signal.Signals, reached: Reached) -> None:
    """A robot side that is told to end in motion ramps to zero first, says so, and leaves nothing behind."""
    with robot() as (endpoint, running, observer):
        states = coming_to_rest(observer, running, how, 0)
        ramp = [state for state in states if state.verdict == "ending"]
        assert len(ramp) >= 0.39 / (3.5 * PERIOD_S) - 1  # every tick of it is told
        assert [state.base.v_x for state in ramp] == sorted((state.base.v_x for state in ramp), reverse=True)
        assert ramp[-1].base.v_x == 0.0
        assert ramp[-1].sentence == "The robot side was told to end: the robot comes to rest."
        bounded(states)
        assert port_is_free(port_of(endpoint))
        steepest = max(before.base.v_x - after.base.v_x for before, after in pairwise(ramp))
        reached.say(
            "INT, TERM, HUP, exception", f"{how.name}: {len(ramp)} ticks to zero, {steepest:.4f} m/s each at most"
        )


def test_a_plug_in_that_leaves_is_a_ramp_too(tmp_path: Path) -> None:
    """A law that ends the process by itself ends it in order: a ramp, then its exit code."""
    with robot(env=install(tmp_path)) as (_, running, observer):
        use(observer, "leaves")
        driver = Driver(observer.link)
        driver.arm()
        end = time.monotonic() + 20.0
        while running.process.poll() is None:
            assert time.monotonic() < end
            driver.send()
            time.sleep(1 / 60)
        assert running.process.returncode == 7
        states = list(observer.states)
        assert max(state.base.v_x for state in states) > 0.2
        assert states[-1].base.v_x == 0.0
        assert states[-1].verdict == "ending"
        bounded(states)


@pytest.mark.parametrize(("how", "code"), [(signal.SIGHUP, 129), (signal.SIGTERM, 143)])
def test_a_terminal_that_closes_ends_drive_in_order(how: signal.Signals, code: int) -> None:
    """`drive` whose terminal is closed ends both halves, with a ramp."""
    with half("drive", "--no-browser") as drive:
        drive.url()
        command = drive.children[0].cmdline()
        endpoint = command[command.index("--listen") + 1]
        observer = Observer(endpoint)
        try:
            states = coming_to_rest(observer, drive, how, code)
        finally:
            observer.close()
        assert [state.base.v_x for state in states if state.verdict == "ending"][-1] == 0.0
        bounded(states)
        until(lambda: port_is_free(port_of(endpoint)), what="a free port")


def test_nohup_is_respected() -> None:
    """Started with SIGHUP ignored, as by nohup, a robot side outlives its terminal."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with robot() as (_, running, observer):
            running.process.send_signal(signal.SIGHUP)
            tick = observer.now.tick
            until(lambda: observer.now.tick > tick + 100, what="going on")
            assert running.process.poll() is None
            assert running.end() == 0
    finally:
        signal.signal(signal.SIGHUP, before)
