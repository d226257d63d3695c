"""Law, feedback and operator at their worst: what is written stays bounded, and zero where nothing may move."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from overreach.control.controller import HandController
from overreach.errors import LONGEST_TOLD
from overreach.law.laws import Exact
from overreach.robots.kinematic import KinematicRobot
from overreach.types import Plan, RobotState, Split
from overreach.verdicts import Motion, Verdict
from tests.laws import Given, exact
from tests.said import push
from tests.side import Side
from tests.states import got, put

ODD = (math.nan, math.inf, -math.inf, 1e308, -1e308, 1e9, -3.0, 0.0, 5e-324)
FIELDS = ("t", "x_b", "y_b", "theta_b", "v_b", "w_b", "theta_1", "theta_2", "dtheta_1", "dtheta_2")
RATES = ("v_b", "w_b", "v_m", "w_m", "mu", "sigma", "scale")
seeds = st.integers(0, 10**9)


class Counted:
    """The exact law, altered; counts its calls."""

    def __init__(self, altered: Callable[[int, Split], Any]) -> None:
        self.calls = 0
        self._altered, self._law = altered, exact()

    def __call__(self, *case: float) -> Split:
        self.calls += 1
        answer: Split = self._altered(self.calls, self._law.split(*case))
        return answer


def plug(altered: Callable[[int, Split], Any], closes: bool = True) -> Given:
    """Return a law whose answers are altered by a function of (number of the call, right answer)."""
    return Given(Counted(altered), "plug", closes)


@settings(max_examples=150)
@given(seeds)
def test_any_plan_and_any_feedback(seed: int) -> None:
    """For any law and any stream of states, in any order and with any acts: bounded, and zero within v/a of a stop."""
    chance = random.Random(seed)
    wild = chance.choice((0.0, 0.002, 0.2))
    kept: list[RobotState] = []

    def state(true: RobotState) -> RobotState | None:
        kept.append(true)
        if chance.random() >= wild:
            return true
        kind = chance.randrange(5)
        if kind == 0:
            return None
        if kind == 1:
            return chance.choice(kept)
        field = chance.choice(FIELDS)
        if kind == 2:
            return put(true, field, got(true, field) + chance.gauss(0.0, 0.3))
        return put(true, field, chance.choice(ODD))

    def answer(_: int, right: Split) -> Any:
        if chance.random() >= wild:
            return right
        kind = chance.randrange(4)
        if kind == 0:
            return chance.choice((None, "nonsense", (1, 2), right.v_b, Split(*"abcdef")))
        if kind == 1:
            raise chance.choice((ValueError, ZeroDivisionError, MemoryError, RecursionError, KeyError))("plug-in")
        return msgspec.structs.replace(right, **{chance.choice(RATES): chance.choice(ODD)})

    side = Side(plug(answer, chance.random() < 0.7), chance.uniform(1.0, 1e5), altered=state)
    for _ in range(12):
        act = chance.randrange(6)
        if act < 3:
            side.reset()
            side.arm()
        side.drive(chance.uniform(0.05, 0.4), chance.uniform(-0.6, 0.6), chance.uniform(-0.6, 0.6))
        if act == 3:
            since = len(side.written)
            side.gate.latch.stop()
            side.drive(0.3)
            side.check_still(since)
        elif act == 4:
            since = len(side.written)
            side.gate.latch.disarm()
            side.drive(0.3)
            side.check_still(since)
    side.check()


WAYS: dict[str, Callable[[RobotState, RobotState, str], RobotState | None]] = {
    "nan": lambda true, _, field: put(true, field, math.nan),
    "inf": lambda true, _, field: put(true, field, math.inf),
    "-inf": lambda true, _, field: put(true, field, -math.inf),
    "1e308": lambda true, _, field: put(true, field, 1e308),
    "bias": lambda true, _, field: put(true, field, got(true, field) + 0.05),
    "far": lambda true, _, field: put(true, field, got(true, field) - 0.8),
    "frozen": lambda true, then, field: put(true, field, got(then, field)),
    "missing": lambda _true, _then, _field: None,
    "repeated": lambda _true, then, _field: then,
}
FLAGGED = {"nan", "inf", "-inf", "missing", "repeated"}


@pytest.mark.parametrize("field", FIELDS)
@pytest.mark.parametrize("way", WAYS)
@settings(max_examples=4)
@given(st.floats(0.5, 7.0), st.floats(0.2, 2.0), seeds)
def test_every_single_fault_of_the_feedback(field: str, way: str, at: float, later: float, seed: int) -> None:
    """One number of the state goes wrong at any time in 10 s: bounds hold; after a Stop or FAULT, zero for ever."""
    chance = random.Random(seed)
    then: list[RobotState] = []
    begin = 50.0 + at

    def altered(true: RobotState) -> RobotState | None:
        if true.t < begin:
            return true
        then.append(true)
        return WAYS[way](true, then[0], field)

    side = Side(altered=altered, dt=0.01)
    side.arm()
    step = None
    stop = min(10.0, at + later)
    while side.now < 50.0 + stop:
        step = side.drive(0.3, chance.uniform(-0.4, 0.4), chance.uniform(-0.4, 0.4))
        side.check(len(side.written) - 31)
    assert step is not None
    if way in FLAGGED:
        assert step.verdict is Verdict.FAULT
        assert step.fault
    since = len(side.written)
    side.gate.latch.stop()
    side.drive(10.0 - min(stop, 9.5))
    side.check()
    side.check_still(since if side.faulted_at is None else min(since, side.faulted_at))


@pytest.mark.parametrize("field", RATES)
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e308])
@settings(max_examples=4)
@given(st.integers(1, 400), st.floats(-0.4, 0.4), st.floats(-0.4, 0.4))
def test_every_single_fault_of_a_law(field: str, bad: float, at: int, v_c: float, w_c: float) -> None:
    """One number of a law's answer goes wrong at any time: FAULT names law and number, or a scale mends it."""
    law = plug(lambda k, right: msgspec.structs.replace(right, **{field: bad}) if k >= at else right)
    side = Side(law)
    side.arm()
    step = side.drive(2.5, v_c, w_c)
    side.check()
    if v_c == 0.0 and w_c == 0.0:  # nothing to move: the law is not asked, and can do no harm
        assert law.share.calls == 0
        assert not any(map(any, side.written))
    elif law.share.calls < at:
        assert step.verdict is not Verdict.FAULT
    elif math.isfinite(bad) and field not in ("scale",):
        assert abs(step.split.v_b) <= 0.6
    else:
        assert step.verdict is Verdict.FAULT
        assert step.fault == f"The law 'plug' answered {field} = {bad}."
        assert not any(step.rates)
    since = len(side.written)
    side.gate.latch.stop()
    side.drive(0.5)
    side.check()
    side.check_still(since)


@pytest.mark.parametrize(
    ("answer", "says"),
    [
        (None, "AttributeError"),
        ("nonsense", "AttributeError"),
        (Split(0.0, 0.0, "fast", 0.0, 0.0, 0.0), "TypeError"),  # type: ignore[arg-type]
        (Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, verdict="go"), "answered the verdict 'go'"),  # type: ignore[arg-type]
        (Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, verdict="moving"), "the verdict 'moving'"),  # type: ignore[arg-type]
        (Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, verdict="no_solution"), "the verdict 'no_"),  # type: ignore[arg-type]
        (Plan(Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (0.1, 0.1, 0.1)), "answered 3 joint rates for 2 joints"),
        (Plan(Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (0.1,)), "answered 1 joint rates for 2 joints"),
        (Plan(Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (0.1, math.nan)), "rates too great"),
        (Split(0.0, 0.0, 1e308, 1e308, 1e308, 1e308), "rates too great"),
        (Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, verdict=Verdict.FAULT), "answered the verdict 'fault'"),
        (Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, verdict="x" * 9999), "answered the verdict 'xxx"),  # type: ignore[arg-type]
    ],
)
def test_nonsense_is_a_fault_of_the_law(answer: Any, says: str) -> None:
    """Whatever a law answers that is no answer: FAULT, at rest and in motion, with what it was."""
    side = Side(plug(lambda k, right: answer if k > 100 else right))
    side.arm()
    step = side.drive(1.5, 0.3)
    assert step.verdict is Verdict.FAULT
    assert says in step.fault
    side.check()
    assert not any(step.rates)


def test_while_nothing_may_move_the_law_is_not_asked() -> None:
    """Disarmed, stopped or faulted, a law is not called: it can neither move the robot nor hold up its ramp."""
    law = plug(lambda k, right: right)
    side = Side(law)
    side.drive(0.2, 0.3)
    assert law.share.calls == 0
    side.arm()
    side.drive(1.5, 0.3)
    for act in (side.gate.latch.disarm, side.gate.latch.stop, lambda: side.controller.guard.latch("why")):
        side.reset()
        side.arm()
        side.drive(0.5, 0.3)
        act()
        side.drive(0.2, 0.3)
        calls = law.share.calls
        step = side.drive(0.5, 0.3)
        assert law.share.calls == calls
        assert not any(step.rates)
        assert step.split.mu > 0.9  # who had the hand is still shown
    side.check()


class Text(float):
    """A number of another type than Python's own, as those of numpy are."""


def test_numbers_of_other_types_are_taken_as_floats() -> None:
    """A law and a driver may speak in numpy's numbers, or in whole ones: what comes out can be sent."""
    other = [np.float64, np.float32, Fraction, Text]

    def answer(k: int, right: Split) -> Split:
        kind = other[k % 4]
        return msgspec.structs.replace(right, v_b=kind(right.v_b), mu=kind(right.mu), w_m=kind(right.w_m))

    def report(true: RobotState) -> RobotState:
        kind = other[round(true.t * 200) % 4]
        return msgspec.structs.replace(
            put(put(true, "x_b", kind(true.x_b)), "v_b", kind(true.v_b)), q=tuple(map(kind, true.q))
        )

    side = Side(plug(answer), altered=report)
    side.arm()
    for _ in range(300):
        step = side.drive(0.005, 0.3, 0.1)
        assert step.verdict is not Verdict.FAULT, step.fault
        msgspec.msgpack.encode(step)
        assert set(map(type, step.rates)) == {float}
    side.check()
    assert max(rates[0] for rates in side.written) > 0.1
    assert "TypeError" in Side(altered=lambda true: put(true, "theta_1", 1j)).drive(0.01).fault  # type: ignore[arg-type]


class Panic(BaseException):
    """What some compiled libraries raise: no Exception."""


class Mute(Exception):  # noqa: N818  # not an error of ours
    """An exception that cannot even say what it is."""

    def __str__(self) -> str:
        raise RuntimeError("no words")


@pytest.mark.parametrize(
    "error",
    [
        ValueError("plug-in\nof two lines"),
        ValueError("\udcff"),
        Panic("rust"),
        Mute(),
        MemoryError(),
        RecursionError("deep"),
        KeyError("x" * 9999),
    ],
)
def test_an_exception_of_a_law_is_a_fault(error: BaseException) -> None:
    """Whatever a law raises, in motion or at rest: one line, a ramp, and nothing leaves the controller."""

    def raising(k: int, right: Split) -> Split:
        if k > 100:
            raise error
        return right

    side = Side(plug(raising))
    side.arm()
    step = side.drive(1.5)
    side.check()
    assert step.verdict is Verdict.FAULT
    assert type(error).__name__ in step.fault
    assert "\n" not in step.fault
    step.fault.encode()  # it can be sent
    assert len(step.fault) < LONGEST_TOLD + 60
    assert not any(step.rates)


@pytest.mark.parametrize(
    "report",
    [
        "nonsense", 7, (), RobotState(*(None,) * 5),  # type: ignore[arg-type]
        RobotState.flat(51.0, 0.0, 0.0, 0.0, 0.0, 0.0, (0.1,), (0.0,)),
        RobotState.flat(51.0, 0.0, "0", 0.0, 0.0, 0.0, (0.1, 0.2), (0.0, 0.0)),  # type: ignore[arg-type]
        RobotState.flat(51.0, 0.0, 0.0, 0.0, 0.0, 0.0, (0.1, 0.2, 0.3), (0.0, 0.0, 0.0)),
    ],
)  # fmt: skip
def test_a_report_that_is_none_is_a_fault(report: Any) -> None:
    """Whatever a driver reports that is no state: FAULT with what it was, a ramp, and nothing leaves the controller."""
    side = Side(altered=lambda true: report if true.t >= 51.0 else true)
    side.arm()
    step = side.drive(1.5)
    side.check()
    assert step.verdict is Verdict.FAULT
    assert step.fault.startswith("The robot's feedback cannot be used: ")
    assert not any(step.rates)


def test_a_fault_is_left_by_reset_arm_and_a_new_press_only() -> None:
    """FAULT stays while its cause does; then arming is refused until a reset, and only a new press moves the robot."""
    broken = True
    side = Side(altered=lambda true: put(true, "theta_1", math.nan) if broken else true)
    side.arm()
    assert side.drive(0.5).verdict is Verdict.FAULT
    side.reset()
    assert side.drive(0.1).verdict is Verdict.FAULT  # its cause is still there
    assert side.gate.arm(11, side.grip, side.now) is Verdict.FAULT
    broken = False
    assert side.drive(0.5).verdict is Verdict.FAULT  # latched
    assert side.gate.tick(side.now, side.dt).verdict is Verdict.FAULT
    side.reset()
    assert not any(side.drive(0.3).rates)
    assert side.gate.tick(side.now, side.dt).verdict is Verdict.DISARMED
    assert side.gate.arm(11, side.grip, side.now) is None
    assert not any(side.drive(0.3).rates)  # the old press
    side.grip += 1
    assert any(side.drive(0.3).rates)
    side.check()


@pytest.mark.parametrize("act", ["disarmed", "stopped", "held at its centre", "released"])
@pytest.mark.parametrize("bias", [0.05, -0.05])
@pytest.mark.parametrize("field", ["v_b", "w_b", "dtheta_1"])
def test_a_biased_speed_moves_nothing_that_should_stand_still(act: str, bias: float, field: str) -> None:
    """A base speed that reads 0.05 too high turns no joint, by nothing at all, once nobody moves the hand."""
    side = Side(altered=lambda true: put(true, field, got(true, field) + bias))
    if act != "disarmed":
        side.arm()
        side.drive(1.0, 0.3)
    if act == "stopped":
        side.gate.latch.stop()
    side.held = act == "held at its centre"
    since = len(side.written)
    side.drive(3.0, 0.0)
    side.check()
    side.check_still(since)


def test_frozen_feedback_then_a_stop() -> None:
    """Feedback that froze in motion turns no joint once the robot was stopped."""
    then: list[RobotState] = []

    def frozen(true: RobotState) -> RobotState:
        if true.t < 51.0:
            return true
        then.append(true)
        return msgspec.structs.replace(then[0], t=true.t)

    side = Side(altered=frozen)
    side.arm()
    side.drive(1.05)
    since = len(side.written)
    side.gate.latch.stop()
    side.drive(5.0)
    side.check()
    side.check_still(since)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("second", [False, True])
def test_a_command_that_is_not_finite_is_none(bad: float, second: bool) -> None:
    """Who drives without a gate and commands NaN gets a ramp, and NOT_FINITE; the next good command is obeyed."""
    robot = KinematicRobot()
    hand = HandController(robot.model, Exact())
    for k in range(300):
        command = (0.2, bad) if second else (bad, 0.0)
        step = hand.decide(robot.read(k / 200), push(*(command if 100 <= k < 200 else (0.2, 0.0))), 1 / 200)
        robot.write(step.base, step.joints, None, k / 200, k / 200)
        if 100 <= k < 200:
            assert step.verdict is Verdict.NOT_FINITE
    assert step.verdict is Verdict.MOVING
    assert any(step.rates)


def test_without_any_state_nothing_moves() -> None:
    """A robot that has reported nothing yet is not moved: FAULT."""
    hand = HandController(KinematicRobot().model, Exact())
    for _ in range(50):
        step = hand.decide(None, push(0.4, 0.0), 0.005)
        assert step.verdict is Verdict.FAULT
        assert step.fault == "The robot has reported nothing yet."
        assert not any(step.rates)


def test_who_tells_no_time_is_given_one() -> None:
    """Without `now` the time is that of the newest state; where states stand still it goes on, and they are frozen."""
    robot = KinematicRobot()
    hand = HandController(robot.model, Exact())
    for k in range(1000):  # a loop that runs 2 % slow, for 5 s
        step = hand.decide(robot.read(k * 0.0051), push(0.2, 0.0), 0.005)
        robot.write(step.base, step.joints, None, k * 0.0051, k * 0.0051)
        assert step.verdict is not Verdict.FAULT
    last = robot.read(999 * 0.0051)
    verdicts = [hand.decide(last, push(0.2, 0.0), 0.005).verdict for _ in range(30)]
    assert verdicts.index(Verdict.FAULT) in (20, 21, 22)


def test_a_law_without_an_answer_ramps_the_whole_robot() -> None:
    """While a law has no solution the robot ramps along its own direction, and stays; the verdict says why."""
    none = Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, Verdict.NO_SOLUTION)
    side = Side(plug(lambda k, right: none if k > 300 else right))
    side.arm()
    side.drive(1.5, 0.3, 0.2)
    before = side.written[-1]
    step = side.drive(0.01, 0.3, 0.2)
    assert step.verdict is Verdict.NO_SOLUTION
    part = step.rates[0] / before[0]
    assert 0.5 < part < 1.0
    assert step.rates == pytest.approx(tuple(rate * part for rate in before), abs=1e-12)
    assert not any(side.drive(0.5, 0.3, 0.2).rates)
    side.check()


def test_the_end_of_a_run_ramps_without_state_or_law() -> None:
    """`ramp` brings the robot to zero from any motion by itself, within v/a, and says so in what it returns."""
    side = Side()
    side.arm()
    side.drive(1.5, 0.4, 0.3)
    assert any(side.written[-1])
    for _ in range(40):
        side.written.append(side.controller.ramp(side.dt).rates)
    side.check()
    side.check_still(len(side.written) - 41 - 11)


def test_motion_is_what_the_gate_says() -> None:
    """A command that is not zero moves nothing where the gate says that nothing may move."""
    robot = KinematicRobot()
    hand = HandController(robot.model, Exact())
    for k in range(100):
        step = hand.decide(robot.read(k / 200), push(0.3, 0.0), 1 / 200, motion=Motion.NONE)
        assert not any(step.rates)
    assert hand.decide(robot.read(0.5), push(0.3, 0.0), 1 / 200).rates[3] != 0.0
