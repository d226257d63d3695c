"""All of these begin at a random time that is not 0: a gate that is right only at t = 0 is wrong."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Callable
from typing import Any

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from overreach.errors import SetupError
from overreach.gate.gate import LOST_S, STALE_S, Gate
from overreach.gate.limits import Limits
from overreach.types import Command, Frame, Twist
from overreach.verdicts import Motion, Verdict
from tests.said import said

DT = 0.005
ME, OTHER = 11, 22
LIMITS = Limits()
RAMP_S = LIMITS.v_c / LIMITS.dv_c
starts = st.floats(1.0, 1e6)


class Bench:
    """A gate with a clock and an operator who counts."""

    def __init__(self, start: float, operator: int = ME) -> None:
        self.gate = Gate()
        self.now = start
        self.seq = 0
        self.grip = 0
        self.operator = operator
        self.out: list[tuple[float, float]] = []

    def stick(self, held: bool = True, v_c: float = 0.4, w_c: float = 0.0) -> Command:
        self.seq += 1
        return said(self.operator, self.seq, self.grip, held, v_c, w_c, seen=self.now)

    def arm(self, grip: int | None = None) -> Verdict | None:
        return self.gate.arm(self.operator, self.grip if grip is None else grip, self.now)

    def press(self) -> None:
        self.grip += 1

    def tick(self, stick: Command | None = None) -> Verdict:
        if stick:
            self.gate.accept(stick, self.now)
        gated = self.gate.tick(self.now, DT)
        self.out.append((gated.twist.v_x, gated.twist.w_z))
        self.now += DT
        return gated.verdict

    def drive(self, seconds: float, every: int = 3, v_c: float = 0.4) -> Verdict:
        verdict = Verdict.DISARMED
        for k in range(round(seconds / DT)):
            verdict = self.tick(self.stick(v_c=v_c) if k % every == 0 else None)
        return verdict

    def silence(self, seconds: float) -> list[Verdict]:
        return [self.tick() for _ in range(round(seconds / DT))]

    @property
    def v_c(self) -> float:
        return self.out[-1][0]


def moving(start: float) -> Bench:
    """Return a bench whose robot is armed and moves at full speed."""
    bench = Bench(start)
    bench.arm()
    bench.press()
    assert bench.drive(0.5) is Verdict.MOVING
    assert bench.v_c == 0.4
    return bench


def driving(start: float = 123.4) -> Bench:
    """Return a bench whose robot moves both ways at once."""
    bench = Bench(start)
    bench.arm()
    bench.press()
    for _ in range(200):
        bench.tick(bench.stick(v_c=0.3, w_c=-0.2))
    assert bench.out[-1] == (0.3, -0.2)
    return bench


WAYS_TO_REST: dict[str, tuple[Callable[[Bench], object], Verdict]] = {
    "stop": (lambda bench: bench.gate.latch.stop(), Verdict.STOPPED),
    "fault": (lambda bench: bench.gate.latch.fail("why"), Verdict.FAULT),
    "disarm": (lambda bench: bench.gate.latch.disarm(), Verdict.DISARMED),
    "spent": (lambda bench: bench.gate.latch.spend(bench.grip), Verdict.REGRIP),
    "other": (lambda bench: bench.gate.latch.arm(OTHER, 0), Verdict.RELEASED),
    "another": (lambda bench: bench.gate.latch.arm(1, 0), Verdict.RELEASED),
}


@pytest.mark.parametrize("way", WAYS_TO_REST)
def test_every_way_to_rest_zeroes_both_parts(way: str) -> None:
    """Stop, fault, disarm, a spent press, another operator: both parts ramp to exactly zero, along their direction."""
    act, verdict = WAYS_TO_REST[way]
    bench = driving()
    act(bench)
    for k in range(60):
        bench.gate.accept(bench.stick(v_c=0.3, w_c=-0.2), bench.now)
        gated = bench.gate.tick(bench.now, DT)
        bench.now += DT
        assert gated.twist.v_x * 0.2 == pytest.approx(-gated.twist.w_z * 0.3)
        assert gated.motion is (Motion.NONE if gated.twist.v_x == 0.0 else Motion.RAMPING)
        if "other" not in way:
            assert gated.verdict is verdict
        assert (gated.twist.v_x, gated.twist.w_z) == (0.0, 0.0) or k < 24
    assert bench.gate.resting


def test_silence_zeroes_both_parts() -> None:
    """Silence of 200 ms, to the last bit, is none; past it both parts ramp (STALE), and past 1 s too (LOST)."""
    for age, verdict in ((0.2, Verdict.MOVING), (1.0, Verdict.STALE)):
        for more, told in ((0.0, verdict), (1e-12, Verdict.STALE if age == 0.2 else Verdict.LOST)):
            gate = Gate()
            gate.arm(ME, 0, 0.0)
            gate.accept(said(ME, 1, 1, True, 0.3, -0.2, seen=0.0), 0.0)
            for _ in range(100):
                gate.tick(0.0, DT)
            assert gate.tick(age + more, DT).verdict is (told if told is not Verdict.STALE else Verdict.STALE)
            gated = gate.tick(age + more, DT)
            assert gated.motion is (Motion.ALLOWED if told is Verdict.MOVING else Motion.RAMPING)
            for _ in range(60):
                gated = gate.tick(age + more, DT)
            assert ((gated.twist.v_x, gated.twist.w_z) == (0.3, -0.2)) is (told is Verdict.MOVING)
            if told is not Verdict.MOVING:
                assert (gated.twist.v_x, gated.twist.w_z) == (0.0, 0.0)
                assert gated.motion is Motion.NONE


def test_a_loss_from_full_speed_spends_the_press_and_zeroes() -> None:
    """A signal that is lost for more than a second at once, in motion: both parts ramp, LOST; its return is REGRIP."""
    bench = driving()
    bench.now += 1.5
    assert bench.tick() is Verdict.LOST
    assert 0.0 < bench.out[-1][0] < 0.3
    assert bench.gate.latch.spent_grip == bench.grip
    for _ in range(60):
        bench.tick()
    assert bench.out[-1] == (0.0, 0.0)
    assert bench.tick(bench.stick(v_c=0.3, w_c=-0.2)) is Verdict.REGRIP


def test_turning_alone_is_motion() -> None:
    """A command that only turns is motion: not at rest, and a gap while it ramps does not spend the press."""
    bench = Bench(50.0)
    bench.arm()
    bench.press()
    gated = bench.gate.tick(bench.now, DT)
    assert gated.motion is Motion.NONE
    for _ in range(100):
        bench.gate.accept(bench.stick(v_c=0.0, w_c=0.4), bench.now)
        gated = bench.gate.tick(bench.now, DT)
        bench.now += DT
    assert (gated.twist.v_x, gated.twist.w_z, gated.motion) == (0.0, 0.4, Motion.ALLOWED)
    assert not bench.gate.resting
    for v_c, w_c in ((0.4, 0.0), (-0.4, 0.0), (0.0, 0.4), (0.0, -0.4)):
        one_way = Bench(50.0)
        one_way.arm()
        one_way.press()
        one_way.tick(one_way.stick(v_c=v_c, w_c=w_c))
        assert one_way.gate.tick(one_way.now, DT).motion is Motion.ALLOWED
        assert not one_way.gate.resting
    bench.now += 0.21
    assert bench.tick() is Verdict.STALE
    assert bench.out[-1][1] > 0.0
    assert bench.gate.latch.spent_grip < bench.grip


def test_held_at_its_centre_is_no_motion() -> None:
    """A stick that is held but not tilted moves nothing, and what was moving ramps down."""
    bench = driving()
    motions = []
    for _ in range(60):
        bench.gate.accept(bench.stick(v_c=0.0, w_c=0.0), bench.now)
        motions.append(bench.gate.tick(bench.now, DT).motion)
        bench.now += DT
    assert motions[0] is Motion.RAMPING
    assert motions[-1] is Motion.NONE


def test_a_refusal_is_told_for_half_a_second() -> None:
    """A refusal is told for 0.5 s, where nothing weightier is; it never hides what is."""
    gate = Gate()
    gate.arm(ME, 0, 0.0)
    assert gate.tick(0.0, DT).verdict is Verdict.RELEASED
    gate.accept(said(ME, 1, 0, False, math.nan, 0.0, seen=0.0), 0.0)
    assert gate.refused == 1
    assert gate.tick(0.0, DT).verdict is Verdict.NOT_FINITE
    assert gate.tick(math.nextafter(0.5, 0.0), DT).verdict is Verdict.NOT_FINITE
    assert gate.tick(0.5, DT).verdict is Verdict.RELEASED
    gate.accept(said(ME, 1, 0, False, math.nan, 0.0, seen=1.0), 1.0)
    gate.latch.stop()
    assert gate.tick(1.0, DT).verdict is Verdict.STOPPED


def test_a_second_operator_waits_for_a_second_of_silence() -> None:
    """Another may arm once the robot rests, in both parts, and the first has not held for 1 s, to the last bit.

    That the first is still there, and says so, does not keep the robot.
    """
    gate = Gate()
    gate.arm(ME, 0, -5.0)
    gate.accept(said(ME, 1, 1, True, 0.0, 0.0, seen=0.0), 0.0)
    gate.tick(0.0, DT)
    gate.accept(said(ME, 2, 1, False, 0.0, 0.0, seen=0.9), 0.9)
    assert gate.arm(OTHER, 0, 1.0) is Verdict.OTHER_OPERATOR
    again = Gate()
    again.arm(ME, 0, 0.0)
    again.accept(said(ME, 1, 1, False, 0.0, 0.0, seen=0.0), 0.0)
    assert again.arm(ME, 0, 1.0) is None
    assert again.seq == 1  # to arm again loses nothing
    assert again.arm(OTHER, 0, 2.0) is Verdict.OTHER_OPERATOR  # but counts as a hold
    assert again.arm(OTHER, 0, math.nextafter(2.0, 3.0)) is None
    assert gate.accept(said(1, 1, 1, True, 0.0, 0.0, seen=1.0), 1.0) is Verdict.OTHER_OPERATOR
    assert gate.arm(OTHER, 0, math.nextafter(1.0, 2.0)) is None
    assert gate.latch.operator == OTHER
    assert gate.seq == 0  # nothing of the first's counts
    gate.accept(said(OTHER, 1, 1, True, 0.0, 0.0, seen=2.0), 2.0)
    assert gate.seq == 1
    assert gate.arm(ME, 0, 2.5) is Verdict.OTHER_OPERATOR
    assert gate.arm(ME, 0, 9.0) is None
    assert gate.seq == 0
    turning = Gate()
    turning.arm(ME, 0, 0.0)
    turning.accept(said(ME, 1, 1, True, 0.0, 0.4, seen=0.0), 0.0)
    turning.tick(0.0, DT)
    assert turning.arm(OTHER, 0, 9.0) is Verdict.OTHER_OPERATOR
    assert Gate().arm(OTHER, 0, 0.0) is None
    silent = Gate()
    silent.arm(ME, 0, 0.0)  # and was never heard
    assert silent.arm(OTHER, 0, 1.0) is Verdict.OTHER_OPERATOR
    assert silent.arm(OTHER, 0, 1.1) is None


@given(starts)
def test_who_was_disarmed_in_motion_does_not_keep_the_robot(start: float) -> None:
    """Another may arm at once, and press; the robot moves for them only after it has come to rest."""
    bench = moving(start)
    bench.gate.latch.disarm()
    other = Bench(start, OTHER)
    other.gate, other.now = bench.gate, bench.now
    assert other.arm() is None
    other.press()
    passed = [other.tick(other.stick(v_c=0.3)) for _ in range(round(RAMP_S / DT) - 1)]
    assert set(passed) == {Verdict.RELEASED}
    assert not bench.gate.resting
    speeds = [v_c for v_c, _ in other.out]
    assert speeds == sorted(speeds, reverse=True)
    assert other.drive(0.5, v_c=0.3) is Verdict.MOVING
    assert min(v_c for v_c, _ in other.out) == 0.0
    assert other.v_c == 0.3


def test_numbers_of_messages_and_presses_begin_at_one() -> None:
    """Message 0 is none, and so is press 0 or any that was spent, whatever number the robot is armed with."""
    gate = Gate()
    gate.arm(ME, -5, 0.0)
    assert gate.accept(said(ME, 0, 1, True, 0.4, 0.0, seen=0.0), 0.0) is Verdict.OUT_OF_ORDER
    assert gate.accept(said(ME, 1, 0, True, 0.4, 0.0, seen=0.0), 0.0) is None
    assert gate.tick(0.0, DT).verdict is Verdict.REGRIP
    gate.latch.spend(3)
    gate.accept(said(ME, 2, 2, True, 0.4, 0.0, seen=0.0), 0.0)
    assert gate.tick(0.0, DT).verdict is Verdict.REGRIP


def test_a_second_of_silence_to_the_last_bit_is_no_loss() -> None:
    """A press that is heard of 1 s after the last message counts; past that, one made during the silence does not."""
    for silence, verdict in ((1.0, Verdict.ACCELERATION), (math.nextafter(1.0, 2.0), Verdict.REGRIP)):
        gate = Gate()
        gate.arm(ME, 0, 0.0)
        gate.accept(said(ME, 1, 1, True, 0.4, 0.0, seen=0.0), 0.0)
        gate.accept(said(ME, 2, 2, True, 0.4, 0.0, seen=silence), silence)
        assert gate.tick(silence, DT).verdict is verdict


def test_what_the_gate_says_cannot_be_changed() -> None:
    """What the gate let through is a record: nobody on the way can alter it."""
    with pytest.raises(AttributeError):
        Gate().tick(0.0, DT).scale = 1.0  # type: ignore[misc]


def test_no_more_than_64_operators_are_remembered() -> None:
    """The last 64 operators' messages are remembered, and no more: the 65th before may begin anew."""
    gate = Gate()
    for operator in range(1, 66):
        gate.accept(said(operator, 5, 1, False, 0.0, 0.0, seen=0.0), 0.0)
    assert gate.accept(said(2, 5, 1, False, 0.0, 0.0, seen=0.0), 0.0) is Verdict.OUT_OF_ORDER
    assert gate.accept(said(1, 5, 1, False, 0.0, 0.0, seen=0.0), 0.0) is None
    assert gate.accept(said(2, 5, 1, False, 0.0, 0.0, seen=0.0), 0.0) is None  # the oldest, for the first came back
    assert gate.accept(said(60, 4, 1, False, 0.0, 0.0, seen=0.0), 0.0) is Verdict.OUT_OF_ORDER
    for operator in range(200, 263):
        gate.accept(said(2, operator, 1, False, 0.0, 0.0, seen=0.0), 0.0)  # who is heard stays
        gate.accept(said(operator, 5, 1, False, 0.0, 0.0, seen=0.0), 0.0)
    assert gate.accept(said(2, 262, 1, False, 0.0, 0.0, seen=0.0), 0.0) is Verdict.OUT_OF_ORDER


def test_what_a_new_gate_knows() -> None:
    """At the start: no message accepted, none refused, at rest, full speed scale."""
    gate = Gate()
    assert (gate.seq, gate.refused, gate.resting, gate.speed_scale) == (0, 0, True, 1.0)
    assert (gate.heard, gate.age) == (0, 0.0)
    gate.arm(ME, 0, 0.0)
    assert gate.accept(said(ME, 1, 1, True, 0.1, 0.0, seen=0.0), 0.0) is None
    assert gate.seq == 1
    assert gate.accept(said(ME, 1, 1, True, 0.1, 0.0, seen=0.0), 0.0) is Verdict.OUT_OF_ORDER
    gate.set_speed_scale(1.0)
    assert gate.tick(0.0, DT).twist.v_x == pytest.approx(2.5 * DT)


def test_speed_and_ramp_are_told() -> None:
    """A command past the speed limit says SPEED and its scale, one that ramps ACCELERATION, else MOVING."""
    gate = Gate()
    gate.arm(ME, 0, 0.0)
    gate.accept(said(ME, 1, 1, True, 0.8, 0.0, seen=0.0), 0.0)
    gated = gate.tick(0.0, 1.0)
    assert (gated.verdict, gated.scale, gated.twist.v_x) == (Verdict.SPEED, 0.5, 0.4)
    gate.accept(said(ME, 2, 1, True, -0.4, 0.0, seen=0.0), 0.0)
    assert gate.tick(0.0, DT).verdict is Verdict.ACCELERATION
    gated = gate.tick(0.0, 1.0)
    assert (gated.verdict, gated.scale, gated.twist.v_x) == (Verdict.MOVING, 1.0, -0.4)


@given(starts)
def test_disarmed_at_start(start: float) -> None:
    """A robot that nobody has armed does not move, whatever is sent."""
    bench = Bench(start)
    bench.press()
    assert bench.drive(0.5) is Verdict.DISARMED
    assert bench.v_c == 0.0


@given(starts)
def test_a_press_from_before_arming_does_not_count(start: float) -> None:
    """Who holds the dead-man while the robot is armed must let go and press again."""
    bench = Bench(start)
    bench.press()
    bench.drive(0.1)
    bench.arm()
    assert bench.drive(0.5) is Verdict.REGRIP
    assert bench.v_c == 0.0
    bench.tick(bench.stick(held=False))
    bench.press()
    bench.drive(0.5)
    assert bench.v_c == 0.4


@given(starts)
def test_release_stops_within_the_ramp(start: float) -> None:
    """Letting go brings the command to zero in v/a, and leaves the robot armed."""
    bench = moving(start)
    bench.tick(bench.stick(held=False))
    assert bench.silence(RAMP_S)[-1] is Verdict.RELEASED
    assert bench.v_c == 0.0
    bench.press()
    bench.drive(0.5)
    assert bench.v_c == 0.4


@settings(max_examples=1_000)
@given(starts, st.floats(0.0, 1.0), st.integers(0, 40))
def test_link_lost_at_any_phase(start: float, phase: float, extra: int) -> None:
    """Whenever the link falls silent, the command is zero within 200 ms + tick + v/a, and 1 s disarms."""
    bench = Bench(start + phase * DT)
    bench.arm()
    bench.press()
    bench.drive(0.3 + extra * DT)
    verdicts = bench.silence(STALE_S + DT + RAMP_S)
    assert bench.v_c == 0.0
    assert set(verdicts[:-1]) <= {Verdict.MOVING, Verdict.ACCELERATION, Verdict.STALE}
    assert bench.silence(LOST_S)[-1] is Verdict.LOST
    # The return of the signal never restarts motion.
    assert bench.drive(0.5) is Verdict.REGRIP
    assert bench.v_c == 0.0
    bench.tick(bench.stick(held=False))
    bench.press()
    bench.drive(0.5)
    assert bench.v_c == 0.4


@given(starts)
def test_a_gap_that_came_to_rest_needs_a_new_press(start: float) -> None:
    """A signal that returns after the ramp has ended moves nothing until the dead-man is pressed again."""
    bench = moving(start)
    bench.silence(STALE_S + DT + RAMP_S + 2 * DT)
    assert bench.drive(0.3) is Verdict.REGRIP
    assert bench.v_c == 0.0


@given(starts)
def test_a_short_gap_goes_on(start: float) -> None:
    """A gap of up to 150 ms is no stop at all; one that ends while still ramping down goes on."""
    bench = moving(start)
    assert Verdict.STALE not in bench.silence(0.15)
    assert bench.v_c == 0.4
    bench.drive(0.1)
    bench.silence(STALE_S + 0.05)
    assert 0.0 < bench.v_c < 0.4
    assert bench.drive(0.3) is Verdict.MOVING
    assert bench.v_c == 0.4


@given(starts)
def test_a_backlog_moves_nothing(start: float) -> None:
    """A sender that was suspended and then sends what it had kept does not restart the robot."""
    bench = moving(start)
    kept = [bench.stick() for _ in range(50)]
    bench.now += 5.0
    for stick in kept:
        bench.gate.accept(stick, bench.now)
    for _ in range(200):
        bench.tick(bench.stick())
    assert bench.v_c == 0.0


@given(starts, st.randoms(use_true_random=False))
def test_order(start: float, chance: random.Random) -> None:
    """A stream with repeats and old messages gives the same output as its sorted, unique self."""
    clean, dirty = moving(start), moving(start)
    for k in range(100):
        speed = chance.uniform(-0.4, 0.4)
        stick = clean.stick(v_c=speed)
        dirty.seq = clean.seq
        clean.tick(stick)
        dirty.gate.accept(stick, dirty.now)
        old = said(ME, chance.randint(1, stick.seq), stick.grip, True, 0.4, 0.4, seen=stick.seen)
        assert dirty.gate.accept(old, dirty.now) is Verdict.OUT_OF_ORDER
        dirty.tick()
        assert k >= 0
    assert clean.out[-100:] == dirty.out[-100:]
    assert dirty.gate.refused == 100


@given(starts, st.sampled_from([math.nan, math.inf, -math.inf]), st.booleans())
def test_not_finite_is_refused(start: float, bad: float, second: bool) -> None:
    """A command that is not finite is refused and told of; it does not count as fresh; output stays finite."""
    bench = moving(start)
    verdicts = []
    for _ in range(round((STALE_S + RAMP_S) / DT) + 4):
        verdicts.append(bench.tick(bench.stick(v_c=0.4 if second else bad, w_c=bad if second else 0.0)))
    assert verdicts[0] is Verdict.NOT_FINITE
    assert set(verdicts) <= {Verdict.NOT_FINITE, Verdict.STALE}
    assert bench.v_c == 0.0
    assert all(math.isfinite(value) for pair in bench.out for value in pair)


@given(starts)
def test_only_who_armed_drives(start: float) -> None:
    """Another operator's stick is refused, and so is his Arm while the first is driving."""
    bench = moving(start)
    assert bench.gate.accept(said(OTHER, 1, 1, True, -0.4, 0.0, seen=bench.now), bench.now) is Verdict.OTHER_OPERATOR
    assert bench.gate.arm(OTHER, 1, bench.now) is Verdict.OTHER_OPERATOR
    bench.drive(0.1)
    assert bench.v_c == 0.4


@given(starts)
def test_taking_over_passes_through_rest_and_a_new_press(start: float) -> None:
    """Who takes over a resting robot moves it only by a press that he makes afterwards, whatever he held before."""
    bench = moving(start)
    bench.tick(bench.stick(held=False))
    other = Bench(start, OTHER)
    other.gate = bench.gate
    other.grip = 1
    bench.silence(0.5)
    assert bench.gate.arm(OTHER, 0, bench.now) is Verdict.OTHER_OPERATOR  # the first was there a moment ago
    bench.silence(LOST_S)
    other.now = bench.now
    other.tick(other.stick())  # held, and refused
    assert other.arm(grip=0) is None
    assert other.drive(0.3) is Verdict.REGRIP
    assert other.v_c == 0.0
    other.press()
    other.drive(0.5)
    assert other.v_c == 0.4
    # Nothing that the first had sent counts again, also if he arms again.
    other.tick(other.stick(held=False))
    other.silence(LOST_S + 0.5)
    bench.now = other.now
    assert bench.arm(grip=0) is None
    assert bench.gate.accept(said(ME, 3, bench.grip, True, 0.4, 0.0, seen=bench.now), bench.now) is Verdict.OUT_OF_ORDER
    assert bench.drive(0.3) is Verdict.REGRIP


@given(starts)
def test_a_press_made_while_nothing_came_through_does_not_count(start: float) -> None:
    """Lost while held: who lets go and presses again during the silence must do so once more after it."""
    bench = moving(start)
    bench.silence(10.0)
    bench.press()
    assert bench.drive(0.5) is Verdict.REGRIP
    assert bench.v_c == 0.0
    bench.tick(bench.stick(held=False))
    bench.press()
    bench.drive(0.5)
    assert bench.v_c == 0.4


@settings(max_examples=300)
@given(starts, st.lists(st.tuples(st.floats(-9, 9), st.floats(-9, 9), st.booleans()), min_size=5, max_size=60))
def test_a_jump_is_a_ramp(start: float, wishes: list[tuple[float, float, bool]]) -> None:
    """Whatever is asked for, the command changes by at most a_max dt a tick and never passes its limits."""
    bench = Bench(start)
    bench.arm()
    bench.press()
    for v_c, w_c, held in wishes:
        bench.tick(bench.stick(held, v_c, w_c))
    for (v0, w0), (v1, w1) in itertools.pairwise([(0.0, 0.0), *bench.out]):
        assert abs(v1 - v0) <= LIMITS.dv_c * DT * (1 + 1e-8)
        assert abs(w1 - w0) <= LIMITS.dw_c * DT * (1 + 1e-8)
        assert abs(v1) <= LIMITS.v_c * (1 + 1e-8)
        assert abs(w1) <= LIMITS.w_c * (1 + 1e-8)


@given(starts)
def test_stop_is_latched(start: float) -> None:
    """A stop brings the command to zero, arming does not lift it, reset lifts it and moves nothing."""
    bench = moving(start)
    bench.gate.latch.stop()
    assert bench.drive(RAMP_S + DT) is Verdict.STOPPED
    assert bench.v_c == 0.0
    assert bench.arm() is Verdict.STOPPED
    assert bench.drive(0.3) is Verdict.STOPPED
    bench.gate.latch.reset()
    assert bench.drive(0.3) is Verdict.DISARMED
    assert bench.v_c == 0.0


@given(starts, st.floats(0.05, 1.0))
def test_speed_scale_scales_the_whole_command(start: float, scale: float) -> None:
    """The speed scale shrinks both parts of the command alike."""
    bench = Bench(start)
    bench.gate.set_speed_scale(scale)
    bench.arm()
    bench.press()
    for _ in range(200):
        bench.tick(bench.stick(v_c=0.4, w_c=-0.2))
    assert bench.out[-1] == pytest.approx((0.4 * scale, -0.2 * scale))


@pytest.mark.parametrize("bad", [0.0, -0.5, 1.01, math.nan])
def test_speed_scale_is_checked(bad: float) -> None:
    """A speed scale that would stop, reverse or speed up the robot is refused."""
    with pytest.raises(SetupError, match="speed scale"):
        Gate().set_speed_scale(bad)


def test_no_way_from_stopped_to_moving_but_reset_arm_release_press() -> None:
    """Of all sequences of up to 6 acts after a stop, only those with reset, arm and a new press, in order, move."""
    acts = ("reset", "arm", "press", "release", "disarm", "stop")
    moved = 0
    for length in range(1, 7):
        for sequence in itertools.product(acts, repeat=length):
            bench = Bench(start=123.456 + length)
            bench.arm()
            bench.press()
            bench.tick(bench.stick())
            bench.gate.latch.stop()
            held = True
            may = "stopped"
            for act in sequence:
                if act == "reset":
                    bench.gate.latch.reset()
                    may = "reset"
                elif act == "arm":
                    bench.arm()
                    may = "armed" if may in ("reset", "armed", "moving") else may
                elif act == "press":
                    held = True
                    bench.press()
                    may = "moving" if may in ("armed", "moving") else may
                elif act == "release":
                    held = False
                    may = "armed" if may == "moving" else may
                elif act == "disarm":
                    bench.gate.latch.disarm()
                    may = "reset" if may in ("armed", "moving") else may
                else:
                    bench.gate.latch.stop()
                    may = "stopped"
                bench.tick(bench.stick(held))
            for _ in range(40):  # what was still ramping down has come to rest
                bench.tick(bench.stick(held))
            went = bench.v_c != 0.0
            assert not went or may == "moving", sequence
            moved += went
    assert moved > 100


def asks(bench: Bench, frame: Frame = Frame.HAND, grip: int | None = None, **parts: Any) -> Command:
    """Return a command of these parts of a twist, or of the gripper."""
    bench.seq += 1
    gripper = parts.pop("gripper", None)
    twist, press = Twist(**parts), bench.grip if grip is None else grip
    return Command(ME, bench.seq, press, True, twist, frame, gripper, seen=bench.now - 0.1)


def test_a_frame_is_taken_at_rest() -> None:
    """At rest, also within a hold, another frame is taken with its command; what is said then is its."""
    bench = Bench(50.0)
    bench.arm()
    bench.press()
    for frame in (Frame.WORLD, Frame.BASE, Frame.HAND):
        bench.gate.accept(asks(bench, frame), bench.now)
        gated = bench.gate.tick(bench.now, DT)
        assert (gated.frame, gated.verdict, gated.twist) == (frame, Verdict.MOVING, Twist())
    bench.gate.accept(asks(bench, Frame.BASE, v_y=0.2), bench.now)
    gated = bench.gate.tick(bench.now, DT)
    assert gated.frame is Frame.BASE
    assert gated.twist == Twist(v_y=2.5 * DT)


def test_a_frame_is_not_changed_in_motion() -> None:
    """In motion a command in another frame ramps down in the old one, REGRIP; the press is spent, a new one drives."""
    bench = moving(50.0)
    for _ in range(100):
        bench.gate.accept(asks(bench, Frame.WORLD, v_y=0.3), bench.now)
        gated = bench.gate.tick(bench.now, DT)
        bench.now += DT
        assert gated.verdict is Verdict.REGRIP
        assert gated.twist.v_y == 0.0
        assert gated.frame is Frame.HAND or gated.motion is Motion.NONE
    assert bench.gate.latch.spent_grip == bench.grip
    assert bench.gate.resting
    bench.press()
    bench.gate.accept(asks(bench, Frame.WORLD, v_y=0.3), bench.now)
    gated = bench.gate.tick(bench.now, DT)
    assert (gated.frame, gated.twist) == (Frame.WORLD, Twist(v_y=2.5 * DT))


LACKED = ("v_z", "w_x", "w_y", "gripper")


@pytest.mark.parametrize("part", LACKED)
def test_what_a_robot_lacks_is_refused(part: str) -> None:
    """A part of a twist, or a gripper, that is not there: the whole command counts as rest, and the part is named."""
    bench = moving(50.0)
    seq = bench.gate.seq
    parts: dict[str, Any] = {"v_x": 0.4, part: 0.05}
    said = asks(bench, **parts)
    assert bench.gate.accept(said, bench.now) is Verdict.NO_SUCH_MOTION
    assert (bench.gate.refused, bench.gate.seq) == (1, seq + 1)
    gated = bench.gate.tick(bench.now, DT)
    assert (gated.verdict, gated.reason) == (Verdict.NO_SUCH_MOTION, f"It has no {part}.")
    assert gated.twist.v_x == pytest.approx(0.4 - 2.5 * DT)
    assert (gated.motion, gated.gripper) == (Motion.RAMPING, None)
    for _ in range(40):
        gated = bench.gate.tick(bench.now, DT)
    assert gated.motion is Motion.NONE
    assert bench.gate.accept(asks(bench, v_x=0.1, v_z=-1e-9, w_x=0.1), bench.now) is Verdict.NO_SUCH_MOTION
    assert bench.gate.tick(bench.now, DT).reason == "It has no v_z, w_x."


def test_what_is_refused_once_is_refused_again() -> None:
    """A command for what the robot lacks is refused each time it comes, and a good one is taken again."""
    bench = moving(50.0)
    for _ in range(3):
        assert bench.gate.accept(asks(bench, v_x=0.4, v_z=0.05), bench.now) is Verdict.NO_SUCH_MOTION
        bench.gate.tick(bench.now, DT)
    assert bench.gate.refused == 3
    assert bench.gate.accept(asks(bench, v_x=0.2), bench.now) is None
    bench.now += 0.6
    bench.gate.accept(asks(bench, v_x=0.2), bench.now)
    gated = bench.gate.tick(bench.now, DT)
    assert (gated.verdict, gated.reason) == (Verdict.ACCELERATION, "")


def test_a_robot_that_has_more_obeys_more() -> None:
    """Where the robot has them, every part of a twist and the gripper, from 0 to 1, come through."""
    gate = Gate(obeys=frozenset(("v_x", "v_y", "v_z", "w_x", "w_y", "w_z", "gripper")))
    gate.arm(ME, 0, 50.0)
    twist = Twist(0.1, 0.1, 0.05, 0.1, 0.1, 0.1)
    for seq, opening in enumerate((0.0, 0.3, 1.0, None), start=1):
        assert gate.accept(Command(ME, seq, 1, True, twist, gripper=opening, seen=50.0), 50.0) is None
        for _ in range(40):
            gated = gate.tick(50.0, DT)
        assert (gated.twist, gated.gripper) == (twist, opening)
    for seq, opening in enumerate((-1e-9, 1.0 + 1e-9), start=10):
        assert gate.accept(Command(ME, seq, 1, True, twist, gripper=opening, seen=50.0), 50.0) is Verdict.NO_SUCH_MOTION
        gated = gate.tick(50.0, DT)
        assert (gated.gripper, gated.reason) == (None, "It has no gripper's opening but 0 to 1.")
    gate.accept(Command(ME, 20, 1, False, twist, gripper=0.5), 50.0)
    assert gate.tick(50.0, DT).gripper is None  # nobody holds


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_every_number_of_a_command_is_finite(bad: float) -> None:
    """Each part of a twist, the gripper and the echo: not finite is refused, and nothing of the message is taken."""
    for field in (*Twist.__struct_fields__, "gripper", "seen"):
        gate = Gate(obeys=frozenset(("v_x", "v_y", "v_z", "w_x", "w_y", "w_z", "gripper")))
        gate.arm(ME, 0, 50.0)
        good = Command(ME, 1, 1, True, gripper=0.5)
        within_twist = field in Twist.__struct_fields__
        wrong = {"twist": Twist(**{field: bad})} if within_twist else {field: bad}
        assert gate.accept(msgspec.structs.replace(good, **wrong), 50.0) is Verdict.NOT_FINITE
        assert gate.seq == 0


def test_what_the_operator_saw_is_kept() -> None:
    """The echo of the last accepted command is kept; before the first there is none."""
    bench = Bench(50.0)
    assert bench.gate.seen is None
    bench.arm()
    bench.press()
    bench.gate.accept(asks(bench, v_x=0.1), bench.now)
    assert bench.gate.seen == 49.9
    bench.gate.accept(Command(ME, bench.seq, 1, True, seen=49.95), bench.now)  # a repeated one
    assert bench.gate.seen == 49.9


def test_the_speed_scale_scales_every_part() -> None:
    """At half the speed scale the same stick means half, in every part; a change of it is used at once."""
    bench = Bench(50.0)
    bench.arm()
    bench.press()
    for scale in (0.5, 0.25, 1.0):
        bench.gate.set_speed_scale(scale)
        for _ in range(100):
            bench.gate.accept(asks(bench, v_x=0.2, w_z=-0.4), bench.now)
            gated = bench.gate.tick(bench.now, DT)
            bench.now += DT
        assert gated.twist == Twist(v_x=0.2 * scale, w_z=-0.4 * scale)
        assert gated.scale == 1.0
    bench.gate.set_speed_scale(0.5)
    for _ in range(100):
        bench.gate.accept(asks(bench, v_x=1.6), bench.now)
        gated = bench.gate.tick(bench.now, DT)
        bench.now += DT
    assert gated.twist.v_x == pytest.approx(0.4)
    assert gated.scale == pytest.approx(0.5)
    assert gated.verdict is Verdict.SPEED


def test_a_command_is_as_old_as_the_state_that_it_echoes() -> None:
    """Up to max_delay, to the last bit, a held command is obeyed; older, of the future, or of none, it is not fresh."""
    for seen, refusal in (
        (50.0, None),
        (49.5, None),
        (math.nextafter(49.5, 0.0), Verdict.DELAYED),
        (math.nextafter(50.0, 60.0), Verdict.DELAYED),
        (None, Verdict.DELAYED),
        (-1e9, Verdict.DELAYED),
    ):
        gate = Gate(max_delay=0.5)
        gate.arm(ME, 0, 50.0)
        assert gate.accept(said(ME, 1, 1, True, 0.3, 0.0, seen=seen), 50.0) is refusal
        assert (gate.tick(50.0, DT).verdict is Verdict.DELAYED) is (refusal is not None)
        assert gate.resting is (refusal is not None)
        assert gate.refused == (refusal is not None)
        assert (gate.heard, gate.seq) == (1, 0 if refusal else 1)
        assert gate.age == (0.0 if seen is None else 50.0 - seen)
        reason = gate.tick(50.0, DT).reason
        assert ("echoes no state of this robot side" in reason) is (seen is None or seen > 50.0)
        assert (" s old, 0.5 s are allowed" in reason) is (seen is not None and seen < 49.5)
        # For rest, no command is too old.
        assert gate.accept(said(ME, 2, 1, False, 0.0, 0.0, seen=seen), 50.0) is None


@pytest.mark.parametrize("other", [ME - 1, ME + 1])
def test_what_was_heard_is_of_who_has_armed(other: int) -> None:
    """Another operator's messages, whatever their number, change neither the newest that was heard nor its age."""
    gate = Gate()
    gate.arm(ME, 0, 50.0)
    gate.accept(said(ME, 3, 1, True, 0.3, 0.0, seen=49.9), 50.0)
    assert (gate.heard, gate.age) == (3, 50.0 - 49.9)
    gate.accept(said(other, 8, 1, True, 0.3, 0.0, seen=49.8), 50.0)
    assert (gate.heard, gate.age) == (3, 50.0 - 49.9)


def test_the_usual_bound_is_0_4_s() -> None:
    """Without another bound a command may be 0.4 s old."""
    for age, refusal in ((0.4, None), (0.41, Verdict.DELAYED)):
        gate = Gate()
        gate.arm(ME, 0, 0.0)
        assert gate.accept(said(ME, 1, 1, True, 0.3, 0.0, seen=0.0), age) is refusal


@given(starts, st.floats(0.41, 30.0))
def test_a_constant_delay_moves_nothing(start: float, delay: float) -> None:
    """However regularly commands come: if each is older than allowed, nothing ever moves, and why is told."""
    bench = Bench(start)
    bench.arm()
    bench.press()
    for k in range(300):
        old = msgspec.structs.replace(bench.stick(), seen=bench.now - delay)
        assert bench.tick(old if k % 3 == 0 else None) is Verdict.DELAYED
    assert not any(v_c or w_c for v_c, w_c in bench.out)
    assert bench.gate.tick(bench.now, DT).reason == f"A command was {delay:.2g} s old, 0.4 s are allowed."


@given(starts, st.floats(1.2, 4.0))
def test_a_growing_delay_comes_to_rest(start: float, slower: float) -> None:
    """On a path that takes `slower` times as long as the stream: rest at most 0.45 s + the bound after letting go."""
    bench = moving(start)
    begun = bench.now
    let_go = begun + 2.0
    sent = [(begun + k * 0.016, k) for k in range(600)]
    for at, _ in sent:
        while bench.now < begun + (at - begun) * slower:
            bench.tick()
        held = at < let_go
        bench.tick(msgspec.structs.replace(bench.stick(held=held), seen=at))
        if bench.now > let_go + 5.0:
            break
    moved = [start + k * DT for k, (v_c, w_c) in enumerate(bench.out) if v_c or w_c]
    assert moved[-1] < let_go + 0.45 + 0.4


def test_a_delay_that_ends_in_time_goes_on_and_one_that_does_not_needs_a_press() -> None:
    """Delayed for 0.3 s: it slows down and goes on by itself; until it rests, or for more than 1 s: let go first."""
    for seconds, verdict in ((0.3, Verdict.MOVING), (0.9, Verdict.REGRIP), (1.5, Verdict.REGRIP)):
        bench = moving(77.0)
        for _ in range(round(seconds / DT)):
            bench.tick(msgspec.structs.replace(bench.stick(), seen=bench.now - 0.5))
        assert bench.drive(0.8) is verdict
        bench.press()
        assert bench.drive(0.8) is Verdict.MOVING


def test_foreign_numbers_push_nobody_out() -> None:
    """Who has armed is remembered, whatever number of others speak: none of their old messages is accepted again."""
    bench = moving(200.0)
    old = [said(ME, k, bench.grip, True, 0.4, 0.4, seen=bench.now) for k in range(1, bench.seq + 1)]
    for operator in range(100, 300):
        bench.gate.accept(said(operator, 10**6, 1, True, 0.4, 0.4, seen=bench.now), bench.now)
    assert all(bench.gate.accept(message, bench.now) is Verdict.OUT_OF_ORDER for message in old)
    # Nor while another drives, nor when it arms again.
    bench.gate.latch.disarm()
    bench.silence(2.0)
    assert bench.gate.arm(OTHER, 0, bench.now) is None
    for operator in range(300, 500):
        bench.gate.accept(said(operator, 10**6, 1, True, 0.4, 0.4, seen=bench.now), bench.now)
    bench.gate.latch.disarm()
    assert bench.gate.arm(ME, 0, bench.now) is None
    assert bench.gate.heard == bench.seq
    assert all(bench.gate.accept(message, bench.now) is Verdict.OUT_OF_ORDER for message in old)


def test_a_stranger_who_arms_is_remembered_as_it_was() -> None:
    """What an operator said before it armed stays old when it does."""
    gate = Gate()
    gate.accept(said(OTHER, 40, 3, True, 0.4, 0.0, seen=9.0), 9.0)
    gate.arm(OTHER, 0, 9.0)
    assert gate.heard == 40
    assert gate.accept(said(OTHER, 40, 4, True, 0.4, 0.0, seen=9.0), 9.0) is Verdict.OUT_OF_ORDER
    assert gate.accept(said(OTHER, 41, 3, True, 0.4, 0.0, seen=9.0), 9.0) is None
    assert gate.tick(9.0, DT).verdict is Verdict.REGRIP


def test_of_those_who_have_armed_the_last_64_are_remembered() -> None:
    """The memory of operators is bounded: the one who armed longest ago, and has been silent since, goes first."""
    gate = Gate()
    for operator in range(1, 66):
        gate.latch.disarm()
        assert gate.arm(operator, 0, 0.0) is None
        gate.accept(said(operator, 5, 1, False, 0.0, 0.0, seen=0.0), 0.0)
    gate.latch.disarm()
    assert gate.accept(said(2, 5, 1, False, 0.0, 0.0, seen=0.0), 0.0) is Verdict.OUT_OF_ORDER
    assert gate.accept(said(65, 5, 1, False, 0.0, 0.0, seen=0.0), 0.0) is Verdict.OUT_OF_ORDER
    assert gate.accept(said(1, 5, 1, False, 0.0, 0.0, seen=0.0), 0.0) is None


def test_a_pause_is_rest_at_once_until_it_is_armed() -> None:
    """When the robot's host is latched the command is zero at once, and only arming and a new press lead on."""
    bench = moving(60.0)
    bench.gate.pause()
    assert bench.gate.resting
    gated = bench.gate.tick(bench.now, DT)
    assert (gated.motion, gated.verdict) == (Motion.NONE, Verdict.PAUSED)
    assert bench.drive(0.2) is Verdict.PAUSED
    bench.press()
    assert bench.drive(0.2) is Verdict.PAUSED
    assert bench.arm() is None
    assert bench.drive(0.1) is Verdict.REGRIP
    bench.press()
    assert bench.drive(0.6) is Verdict.MOVING
    bench.gate.pause()
    bench.gate.latch.stop()
    assert bench.tick() is Verdict.STOPPED


@pytest.mark.parametrize("bad", [math.nan, math.inf, 0.0, -0.4, 0.09, 2.1])
def test_the_bound_on_the_delay_cannot_be_switched_off(bad: float) -> None:
    """A bound that no command can keep, or that nobody can drive with, is refused at set-up."""
    with pytest.raises(SetupError, match=r"--max-delay must be 0\.1 to 2 s"):
        Gate(max_delay=bad)
    assert (Gate(max_delay=0.1).max_delay, Gate(max_delay=2.0).max_delay) == (0.1, 2.0)
