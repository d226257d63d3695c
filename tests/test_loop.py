from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from itertools import pairwise
from typing import Any

import msgspec
import pytest

from overreach.clock import SteppedClock
from overreach.errors import SetupError
from overreach.law.body import NO_SOLUTION, Planner
from overreach.law.laws import Law
from overreach.link.endpoint import free_port
from overreach.link.messages import Accepted, Answer, Choice, ConfigureRequest, Refused, Settings, State
from overreach.link.robot_end import RobotEnd
from overreach.model.model import Model
from overreach.model.planar import planar
from overreach.model.workspace import Workspace
from overreach.requests import RestartRequest
from overreach.robot_side.loop import Loop
from overreach.robot_side.settings import Built, build
from overreach.robots.kinematic import KinematicRobot
from overreach.types import BaseTwist, RobotState, Split
from overreach.verdicts import Verdict
from tests.laws import Given, exact
from tests.said import said

PERIOD = 0.005


@pytest.mark.parametrize("late", [0.0123, 0.0049, 1.0])
def test_an_overrun_is_counted_and_never_made_up_for(late: float) -> None:
    """After a stall the loop leaves out what it has missed: no two ticks in one period, all on the beat."""
    start = 100.0
    clock = SteppedClock(start)
    link = RobotEnd(f"tcp/127.0.0.1:{free_port()}", "planar")
    try:
        loop = Loop(KinematicRobot(now=start), link, clock, 1.0 / PERIOD)
        ticks: list[float] = []
        whole = loop.tick

        def tick(now: float, dt: float) -> None:
            ticks.append(now)
            whole(now, dt)
            if len(ticks) == 10:
                clock.t += late  # the machine stalls in the middle of a tick

        loop.tick = tick  # type: ignore[method-assign]  # the real tick, and a note of when it was
        loop.run(lambda: len(ticks) < 30)
    finally:
        link.close()
    periods = [round((at - start) / PERIOD, 6) for at in ticks]
    slots = [int(period) for period in periods]
    assert len(set(slots)) == len(slots)
    assert periods == [float(slot) for slot in slots]  # always on the beat
    assert loop.overruns == slots[-1] - len(slots)
    assert loop.overruns == int(late / PERIOD)


class Driver:
    """A robot's driver that keeps what is written, and raises when it is told to."""

    def __init__(self, now: float) -> None:
        self.robot = KinematicRobot(now=now)
        self.model, self.simulated = self.robot.model, True
        self.written: list[tuple[float, ...]] = []
        self.stopped = 0
        self.unreadable: Exception | None = None
        self.unwritable: Exception | None = None

    def read(self, now: float) -> RobotState:
        if self.unreadable:
            raise self.unreadable
        return self.robot.read(now)

    def write(
        self, base: BaseTwist, joints: tuple[float, ...], gripper: float | None, now: float, deadline: float
    ) -> None:
        if self.unwritable:
            raise self.unwritable
        assert deadline > now
        self.written.append((base.v_x, base.w_z, *joints))
        self.robot.write(base, joints, gripper, now, deadline)

    def stop(self, now: float) -> None:
        self.stopped += 1
        self.robot.stop(now)

    def restart(self, now: float) -> None:
        self.robot.restart(now)


class Bench:
    """A loop on a stepped clock, with a real link, and an operator who pushes forward."""

    def __init__(self, link: RobotEnd) -> None:
        self.clock = SteppedClock(100.0)
        self.driver = Driver(100.0)
        self.loop = Loop(self.driver, link, self.clock, 1.0 / PERIOD)
        self.seq = 0
        self.loop.pilot.gate.arm(7, 0, self.clock.now())

    def push(self) -> None:
        self.seq += 1
        self.loop.pilot.gate.accept(said(7, self.seq, 1, True, 0.4, 0.0), self.clock.now())

    def drive(self, ticks: int, at: Callable[[int], object] = lambda k: None) -> None:
        """Run for `ticks`, with the act `at` before each."""
        count = 0

        def running() -> bool:
            nonlocal count
            at(count)
            self.push()
            count += 1
            return count <= ticks

        self.loop.run(running)

    def check(self) -> None:
        """All that was written keeps the accelerations of base and joints, and ends at zero; then one stop."""
        assert max(rates[0] for rates in self.driver.written) > 0.3
        for before, after in pairwise(self.driver.written):
            for was, is_, change in zip(before, after, (3.5, 12.0, 20.0, 20.0), strict=True):
                assert abs(is_ - was) <= change * PERIOD * (1 + 1e-9)
        assert self.driver.written[-1] == (0.0, 0.0, 0.0, 0.0)
        assert self.driver.stopped == 1


@pytest.fixture
def bench() -> Iterator[Bench]:
    link = RobotEnd(f"tcp/127.0.0.1:{free_port()}", "planar")
    try:
        yield Bench(link)
    finally:
        link.close()


def test_a_run_that_ends_in_motion_ramps(bench: Bench) -> None:
    """A run that is told to end writes a ramp to zero, on the beat, before it stops the robot."""
    bench.drive(300)
    bench.check()
    ramp = bench.driver.written[300:]
    assert 20 <= len(ramp) <= 35


@pytest.mark.parametrize("error", [RuntimeError("link"), KeyboardInterrupt(), SystemExit(3)])
def test_an_exception_ends_a_run_with_a_ramp(bench: Bench, error: BaseException) -> None:
    """Whatever ends a run, by whatever part of it, the robot ramps to zero first; then the exception goes on."""

    def raising(k: int) -> None:
        if k == 300:
            raise error

    with pytest.raises(type(error)):
        bench.drive(400, raising)
    bench.check()


def test_a_link_that_raises_does_not_keep_the_robot_from_its_ramp(bench: Bench) -> None:
    """A link that is gone ends the run; the ramp goes on without it."""

    def gone(k: int) -> None:
        if k == 300:
            bench.loop._link.close()

    with contextlib.suppress(Exception):
        bench.drive(400, gone)
    bench.check()


@pytest.mark.parametrize("error", [OSError("no such device"), ValueError("checksum")])
def test_a_robot_that_cannot_be_read_is_a_fault(bench: Bench, error: Exception) -> None:
    """A driver that raises on read: FAULT with what it said, a ramp; the loop goes on; a reset finds it well."""

    def broken(k: int) -> None:
        bench.driver.unreadable = error if 300 <= k < 400 else None
        if k == 390:
            assert bench.loop.pilot.gate.latch.fault == f"The robot could not be read: {type(error).__name__}: {error}."
            assert bench.driver.written[-1] == (0.0, 0.0, 0.0, 0.0)
            assert bench.loop.pilot.gate.tick(bench.clock.now(), PERIOD).verdict is Verdict.FAULT
        if k == 410:
            bench.loop.pilot.gate.latch.reset()
            bench.loop.pilot.controller.reset()
            assert bench.loop.pilot.gate.arm(7, 0, bench.clock.now()) is None

    bench.drive(500, broken)
    bench.check()
    assert bench.loop.pilot.gate.latch.fault == ""


def test_a_robot_that_cannot_be_written_to_is_a_fault(bench: Bench) -> None:
    """A driver that raises on write: FAULT; what is written when it can be again is on the way to zero."""

    def broken(k: int) -> None:
        bench.driver.unwritable = OSError("cable") if 300 <= k < 303 else None
        if k == 302:
            assert bench.loop.pilot.gate.latch.fault == "The robot could not be written to: OSError: cable."

    bench.drive(400, broken)
    assert max(rates[0] for rates in bench.driver.written) > 0.3
    after = [rates[0] for rates in bench.driver.written[300:]]
    assert after == sorted(after, reverse=True)
    assert after[-1] == 0.0


@pytest.mark.parametrize(("slow", "fault"), [(2, False), (3, True)])
def test_a_law_that_is_slow_three_times_is_a_fault(bench: Bench, slow: int, fault: bool) -> None:
    """A decision that takes longer than a period is an overrun; three of late are a fault of the law."""
    law, calls = exact(), 0

    def share(*case: float) -> Split:
        nonlocal calls
        calls += 1
        if calls % 50 < slow:
            bench.clock.t += 1.01 * PERIOD
        return law.split(*case)

    bench.loop.pilot.controller.configure(Given(share, "slow"))
    bench.drive(300)
    assert bench.loop.overruns > 0
    assert (bench.loop.pilot.gate.latch.fault == "The law 'slow' takes 5 ms; a period has 5 ms.") is fault


def test_verdicts_are_told_by_their_weight(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of what gate and law say the weightier is told: NO_SOLUTION over SPEED, STOPPED over that, with its look."""
    states: list[State] = []
    monkeypatch.setattr(bench.loop._link, "publish", states.append)
    bench.loop.pilot.controller.configure(Given(lambda *_: NO_SOLUTION, "unsolved"))

    def too_fast(k: int) -> None:
        bench.seq += 1
        bench.loop.pilot.gate.accept(said(7, bench.seq, 1, True, 0.8, 0.0), bench.clock.now())
        if k == 150:
            bench.loop.pilot.gate.latch.stop()

    bench.push = lambda: None  # type: ignore[method-assign]  # another operator
    bench.drive(300, too_fast)
    told = [(state.verdict, state.look, state.sentence) for state in states]
    assert list(dict.fromkeys(told)) == [
        (verdict.value, verdict.look, verdict.sentence)
        for verdict in (Verdict.NO_SOLUTION, Verdict.STOPPED, Verdict.ENDING)
    ]
    assert states[30].scale == 0.0


@pytest.mark.parametrize(("every", "takes"), [(1, 0.1), (2, 0.03), (3, 0.04), (100, 0.06)])
def test_a_slow_law_does_not_stretch_a_stop(bench: Bench, every: int, takes: float) -> None:
    """However slow a law is, and how often: after a stop zero is written within v/a and what three decisions took."""
    law, calls = exact(), 0
    stopped_at = still_at = 0.0

    def share(*case: float) -> Split:
        nonlocal calls
        calls += 1
        if stopped_at and calls % every == 0:
            bench.clock.t += takes
        return law.split(*case)

    bench.loop.pilot.controller.configure(Given(share, "slow"))

    def stop(k: int) -> None:
        nonlocal stopped_at, still_at
        if k == 300:
            stopped_at = bench.clock.now()
            bench.loop.pilot.gate.latch.stop()
        if stopped_at and not still_at and not any(bench.driver.written[-1]):
            still_at = bench.clock.now()

    bench.drive(500, stop)
    bench.check()
    assert 0.0 < still_at - stopped_at <= 0.6 / 3.5 + 3 * PERIOD + 3 * takes


def test_the_end_makes_up_for_nothing(bench: Bench) -> None:
    """A write that is held up while the robot comes to rest is not made up for: no two writes in one period."""
    at: list[float] = []
    write = bench.driver.write

    def held_up(*arguments: Any) -> None:
        write(*arguments)
        at.append(bench.clock.now())
        if len(at) == 305:
            bench.clock.t += 0.1

    bench.driver.write = held_up  # type: ignore[assignment,method-assign]  # the real one, and a note of when it was
    bench.drive(300)
    bench.check()
    assert all(later - earlier >= 0.999 * PERIOD for earlier, later in pairwise(at[:-1]))


class Half(Law, frozen=True):
    """A law that can be made and not be used."""

    name = "half"

    def planner(self, model: Model) -> Planner:
        raise ZeroDivisionError("a plug-in's own")


def test_settings_are_used_all_or_none(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """A law that cannot be used leaves law, workspace and speed as they were, and is told."""
    loop, pilot = bench.loop, bench.loop.pilot
    answers: list[Answer] = []
    before = (pilot.controller.law, pilot.model, pilot.gate.speed_scale, loop.settings)
    wanted = msgspec.structs.replace(loop.settings, law=Choice("exact"), speed_scale=0.3)
    other = planar(workspace=Workspace(0.5, 0.8, -0.5, 0.5))
    done: Future[Built] = Future()
    done.set_result(Built(wanted, Half(), other))
    monkeypatch.setattr(loop._builder, "begin", lambda *_: done)
    loop._begin(ConfigureRequest(wanted), answers.append)
    loop.tick(bench.clock.now(), PERIOD)
    assert answers == [Refused("Fault: the robot side met ZeroDivisionError: a plug-in's own.")]
    assert (pilot.controller.law, pilot.model, pilot.gate.speed_scale, loop.settings) == before


def test_settings_are_made_beside_the_loop(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """While settings are made ready the loop goes on with those in force; further ones meanwhile are refused."""
    loop = bench.loop
    answers: list[Answer] = []
    begun: list[Settings] = []
    going: Future[Built] = Future()

    def begin(settings: Settings, model: Model) -> Future[Built]:
        begun.append(settings)
        return going

    monkeypatch.setattr(loop._builder, "begin", begin)
    wanted = msgspec.structs.replace(loop.settings, workspace=Workspace(0.5, 0.8, -0.5, 0.5), speed_scale=0.3)
    loop._begin(ConfigureRequest(wanted), answers.append)
    with pytest.raises(SetupError, match="being made ready"):
        loop._begin(ConfigureRequest(wanted), answers.append)
    bench.drive(20)
    assert (begun, answers) == ([wanted], [])
    assert loop.pilot.gate.speed_scale == 1.0
    going.set_result(build(wanted, loop._model))
    loop.tick(bench.clock.now(), PERIOD)
    assert answers == [Accepted()]
    assert (loop.pilot.gate.speed_scale, loop.pilot.model.workspace) == (0.3, wanted.workspace)


def test_at_rest_is_when_nothing_is_written(bench: Bench) -> None:
    """A robot whose command is zero but which is still ramping is not at rest: it is not put back to its start."""

    def let_go(k: int) -> None:
        loop = bench.loop
        if k == 300:
            loop.pilot.controller.guard.latch("why")
        if k > 300:
            assert loop.pilot.resting is not any(loop.pilot.controller.guard.written) or not loop.pilot.gate.resting
        if k > 302 and any(loop.pilot.controller.guard.written):
            assert isinstance(loop._carry_out(RestartRequest(), bench.clock.now()), Refused)

    bench.drive(400, let_go)
    bench.check()
