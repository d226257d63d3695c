from __future__ import annotations

import contextlib
import math
from array import array
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from itertools import pairwise
from threading import current_thread
from typing import Any

import msgspec
import numpy as np
import pytest

from overreach.arm.mount import Mount
from overreach.arm.planar import Arm2R, Chain2R
from overreach.clock import SteppedClock
from overreach.control.pilot import Pilot, replay
from overreach.control.tick import Tick
from overreach.errors import SetupError
from overreach.law.body import NO_SOLUTION
from overreach.law.laws import Exact, Law, Share
from overreach.link.endpoint import free_port
from overreach.link.messages import Accepted, Answer, Choice, ConfigureRequest, Refused, Settings, State, decode_state
from overreach.link.robot_end import RobotEnd
from overreach.model.model import Model
from overreach.model.planar import planar
from overreach.model.workspace import Workspace
from overreach.requests import RestartRequest
from overreach.robot_side import settings as settings_module
from overreach.robot_side.loop import Loop
from overreach.robot_side.settings import Built, build
from overreach.robots.kinematic import KinematicRobot
from overreach.types import BaseTwist, Command, RobotState, Split
from overreach.verdicts import Verdict
from tests.laws import Given, exact
from tests.processes import until
from tests.said import said
from tests.serial import SerialRobot, six

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

    def arm(self, now: float) -> None:
        self.robot.arm(now)

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
        self.loop.pilot.gate.accept(said(7, self.seq, 1, True, 0.4, 0.0, seen=self.clock.now()), self.clock.now())

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
    monkeypatch.setattr(bench.loop._link, "publish", lambda state: states.append(decode_state(state)))
    bench.loop.pilot.controller.configure(Given(lambda *_: NO_SOLUTION, "unsolved"))

    def too_fast(k: int) -> None:
        bench.seq += 1
        bench.loop.pilot.gate.accept(said(7, bench.seq, 1, True, 0.8, 0.0, seen=bench.clock.now()), bench.clock.now())
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


def test_settings_are_used_all_or_none(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """A law that cannot be used leaves law, workspace and speed as they were, and is told."""
    loop, pilot = bench.loop, bench.loop.pilot
    answers: list[Answer] = []
    before = (pilot.controller.law, pilot.model, pilot.gate.speed_scale, loop.settings)
    wanted = msgspec.structs.replace(loop.settings, law=Choice("exact"), speed_scale=0.3)
    done: Future[Built] = Future()
    done.set_exception(ZeroDivisionError("a plug-in's own"))
    monkeypatch.setattr(loop._builder, "begin", lambda *_: done)
    loop._begin(ConfigureRequest(wanted), answers.append)
    loop.tick(bench.clock.now(), PERIOD)
    assert answers == [Refused("Fault: the robot side met ZeroDivisionError: a plug-in's own.")]
    assert (pilot.controller.law, pilot.model, pilot.gate.speed_scale, loop.settings) == before


def test_settings_are_made_beside_the_loop(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """While settings are made ready the loop goes on with those in force; others meanwhile are refused.

    Who asks for the same once more has the answer, instead of who asked before.
    """
    loop = bench.loop
    answers: list[Answer] = []
    earlier: list[Answer] = []
    begun: list[Settings] = []
    going: Future[Built] = Future()

    def begin(settings: Settings, model: Model, hand: str) -> Future[Built]:
        begun.append(settings)
        return going

    monkeypatch.setattr(loop._builder, "begin", begin)
    wanted = msgspec.structs.replace(loop.settings, workspace=Workspace(0.5, 0.8, -0.5, 0.5), speed_scale=0.3)
    loop._begin(ConfigureRequest(wanted), earlier.append)
    with pytest.raises(SetupError, match="being made ready"):
        loop._begin(ConfigureRequest(msgspec.structs.replace(wanted, speed_scale=0.4)), answers.append)
    loop._begin(ConfigureRequest(wanted), answers.append)
    bench.drive(20)
    assert (begun, answers) == ([wanted], [])
    assert loop.pilot.gate.speed_scale == 1.0
    going.set_result(build(wanted, loop._model))
    loop.tick(bench.clock.now(), PERIOD)
    assert (answers, earlier) == ([Accepted()], [])
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


class Compiled(Law, frozen=True):
    """A law that notes where it is made."""

    name = "compiled"
    notes: list[str] = []

    def bind(self, model: Model) -> Share:
        self.notes.append(current_thread().name)
        return Exact().bind(model)


def test_a_law_is_made_once_and_not_on_the_loops_thread(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """What a law does when it meets the robot, compiling for one, is done beside the loop, once; the loop takes it."""
    law, answers = Compiled(), []  # type: ignore[var-annotated]
    monkeypatch.setattr(settings_module, "load_law", lambda *_: law)
    bench.loop._begin(ConfigureRequest(bench.loop.settings), answers.append)
    assert bench.loop._building
    until(bench.loop._building.future.done, what="the law")
    bench.loop.tick(bench.clock.now(), PERIOD)
    assert answers == [Accepted()]
    assert bench.loop.pilot.controller.law is law
    assert law.notes == ["settings"]


def test_while_libraries_load_nobody_drives(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """A press made while a slow law is loaded moves nothing, then or later: only a new press does, whoever watches.

    All of it is in the ticks: replayed, they are the same.
    """
    loop, going = bench.loop, Future()  # type: ignore[var-annotated]
    monkeypatch.setattr(loop._builder, "begin", lambda *_: going)
    wanted = msgspec.structs.replace(loop.settings, law=Choice("holistic"))
    commands: list[Command | None] = []
    monkeypatch.setattr(loop._link, "newest_command", lambda _operator: commands.pop() if commands else None)
    begun, law, whole = bench.clock.now(), loop.pilot.controller.law, loop.pilot.tick
    ticks: list[Tick] = []

    def tick(*given: Any) -> Tick:
        ticks.append(whole(*given))
        return ticks[-1]

    monkeypatch.setattr(loop.pilot, "tick", tick)
    loop._begin(ConfigureRequest(wanted), lambda answer: None)
    for k in range(300):
        if k == 100:
            going.set_result(build(loop.settings, loop._model))
        mine = said(7, k + 1, 1 if k < 200 else 2, True, 0.4, 0.0, seen=bench.clock.now())
        commands.append(said(8, 1, 1000, True, 0.4, 0.0) if k == 50 else mine)
        loop.tick(bench.clock.now(), PERIOD)
        bench.clock.t += PERIOD
        moving = bench.driver.written[-1][2] != 0.0
        assert moving is (k >= 200)
    again = Pilot(loop._model, law)
    again.gate.arm(7, 0, begun)
    assert list(replay(again, ticks)) == ticks


@pytest.mark.parametrize("width", [1e-320, 1e-5, 0.01, 3e4, 1e300])
@pytest.mark.parametrize("blend", ["tanh", "smoothstep"])
def test_any_width_of_a_blend_is_drawn_in_few_points(blend: str, width: float) -> None:
    """However wide or narrow a blend is, what is drawn of it is small, and nothing raises."""
    model = planar()
    names = ("alpha", "beta") if blend == "tanh" else ("q_l", "q_psi")
    for name in names:
        scene = build(Settings(model.workspace, blend=Choice(blend, {name: width})), model).scene
        assert sum(len(band) for band in scene.bands) < 900
        assert all(math.isfinite(x) and math.isfinite(y) for band in scene.bands for x, y in band)


class OddNumbers(Driver):
    """A driver that reports what drivers like to report."""

    kind: Callable[[tuple[float, ...]], Any] = list

    def read(self, now: float) -> RobotState:
        state = self.robot.read(now)
        kind = type(self).kind
        return msgspec.structs.replace(state, q=kind(state.q), dq=kind(state.dq), t=np.float64(state.t))


@pytest.mark.parametrize(
    "kind", [list, lambda q: array("d", q), deque, np.array], ids=["list", "array", "deque", "numpy"]
)
def test_whatever_kind_of_numbers_a_robot_reports(bench: Bench, kind: Callable[..., Any]) -> None:
    """Joints as a list, an array, a deque or numpy's: they are driven, and told on the wire."""
    states: list[State] = []
    driver = OddNumbers(bench.clock.now())
    type(driver).kind = staticmethod(kind)
    bench.driver = driver
    bench.loop._robot = driver
    bench.loop._link.publish = lambda state: states.append(decode_state(state))  # type: ignore[method-assign]
    bench.drive(200)
    bench.check()
    assert bench.loop.pilot.gate.latch.fault == ""
    assert states[-10].joints == driver.robot.true.q or len(states[-10].joints) == 2


def test_a_list_that_is_filled_again_and_again_changes_nothing_that_was_believed(bench: Bench) -> None:
    """A driver that hands out one list for ever, and puts infinity into it: FAULT, and a ramp to the end."""
    joints = [0.0, 0.0]

    class Refills(Driver):
        bad = False

        def read(self, now: float) -> RobotState:
            state = self.robot.read(now)
            joints[:] = [math.inf, math.inf] if self.bad else state.q
            return msgspec.structs.replace(state, q=joints)

    driver = Refills(bench.clock.now())
    bench.driver = bench.loop._robot = driver

    def breaks(k: int) -> None:
        driver.bad = k >= 300

    bench.drive(320, breaks)
    bench.check()
    assert "not finite" in bench.loop.pilot.gate.latch.fault


def test_an_arm_in_space_is_driven_by_the_loop() -> None:
    """The second kind of arm, in the real loop on a real link: it moves as pushed, and what is told can be read."""
    clock, states = SteppedClock(100.0), []
    link = RobotEnd(f"tcp/127.0.0.1:{free_port()}", "serial")
    try:
        loop = Loop(KinematicRobot(SerialRobot(six()), now=100.0), link, clock, 1.0 / PERIOD)
        link.publish = lambda state: states.append(decode_state(state))  # type: ignore[method-assign]
        loop.pilot.gate.arm(7, 0, clock.now())
        for k in range(300):
            loop.pilot.gate.accept(said(7, k + 1, 1, True, 0.3, 0.0, seen=clock.now()), clock.now())
            loop.tick(clock.now(), PERIOD)
            clock.t += PERIOD
        assert loop.pilot.gate.latch.fault == ""
        assert states[-1].verdict == "moving"
        assert states[-1].hand[0] - states[0].hand[0] > 0.3
        assert len(states[-1].links) == 7
        assert math.hypot(*states[-1].velocity) == pytest.approx(0.3, abs=1e-6)
    finally:
        link.close()


def test_an_arm_that_raises_is_a_fault_and_a_ramp(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """Kinematics that raise from some pose on: FAULT with what was raised; the robot ramps, to the end."""
    whole = Arm2R.at
    broken = False

    def at(arm: Arm2R, joints: tuple[float, ...], mount: Mount) -> Chain2R:
        if broken:
            raise ArithmeticError("singular")
        return whole(arm, joints, mount)

    monkeypatch.setattr(Arm2R, "at", at)

    def breaks(k: int) -> None:
        nonlocal broken
        broken = k >= 300

    bench.drive(330, breaks)
    bench.check()
    assert bench.loop.pilot.gate.latch.fault == "The arm's kinematics raised ArithmeticError: singular."


def test_what_cannot_be_told_is_a_fault(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """A state that cannot be put into bytes stops the robot with the reason, and not the loop."""
    told = bench.loop._reporter.state
    odd = False

    def state(*arguments: Any) -> Any:
        right = told(*arguments)
        return msgspec.structs.replace(right, hand=object()) if odd else right

    monkeypatch.setattr(bench.loop._reporter, "state", state)

    def breaks(k: int) -> None:
        nonlocal odd
        odd = k >= 300

    bench.drive(350, breaks)
    bench.check()
    assert bench.loop.pilot.gate.latch.fault.startswith("The robot's state cannot be told: TypeError")
