"""The guard alone: any rates in, bounded rates out. Every bound here is a number, not one read from what is tested."""

from __future__ import annotations

import math
import random
from itertools import pairwise, product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from overreach.gate.guard import Guard
from overreach.types import Channel
from overreach.verdicts import Motion

CHANNELS = (
    Channel("v_b", "the base's place", "m", 0.6, 3.5),
    Channel("w_b", "the base's heading", "rad", 2.0, 12.0),
    Channel("dtheta_1", "theta_1", "rad", 3.0, 20.0),
    Channel("dtheta_2", "theta_2", "rad", 3.0, 20.0),
)
MOST = (0.6, 2.0, 3.0, 3.0)
CHANGE = (3.5, 12.0, 20.0, 20.0)
STOP_S = 0.6 / 3.5
"""The longest v/a of the four."""
DT = 0.005
ZERO = (0.0, 0.0, 0.0, 0.0)
HALF = (0.3, 1.0, 1.5, -1.5)
ANY = (math.nan, math.inf, -math.inf, 1e308, -1e308, 5e-324, 0.0)
periods = st.floats(0.001, 0.02)


def drive(guard: Guard, goal: tuple[float, ...], dt: float = DT, ticks: int = 400) -> None:
    """Bring what is written to `goal` as fast as the bounds allow."""
    for _ in range(ticks):
        wanted = tuple(
            max(was - most * dt, min(was + most * dt, end))
            for was, end, most in zip(guard.written, goal, CHANGE, strict=True)
        )
        guard.write(wanted, Motion.ALLOWED, dt)
    assert guard.written == pytest.approx(goal)
    assert guard.fault == ""


def keeps_bounds(before: tuple[float, ...], after: tuple[float, ...], dt: float) -> bool:
    """Say whether a write keeps speed and acceleration."""
    return all(
        math.isfinite(is_) and abs(is_) <= most and abs(is_ - was) <= change * dt * (1 + 1e-9) + 1e-15
        for was, is_, most, change in zip(before, after, MOST, CHANGE, strict=True)
    )


@settings(max_examples=300)
@given(st.integers(0, 10**9), periods)
def test_whatever_is_wanted_what_is_written_is_bounded(seed: int, dt: float) -> None:
    """For any stream of wanted rates, NaN, infinity and 1e308 included, any motion and resets at any time: bounded."""
    chance = random.Random(seed)
    guard = Guard(CHANNELS, 0.0)
    for _ in range(200):
        near = [
            was + chance.uniform(-1.2, 1.2) * change * dt for was, change in zip(guard.written, CHANGE, strict=True)
        ]
        wanted = [chance.choice(ANY) if chance.random() < 0.01 else chance.uniform(-4, 4) for _ in near]
        if chance.random() < 0.9:
            wanted = near
        before = guard.written
        guard.write(wanted, chance.choices(tuple(Motion), (8, 1, 1))[0], dt)
        assert keeps_bounds(before, guard.written, dt)
        if chance.random() < 0.2:
            guard.reset()


@given(st.tuples(*(st.floats(-most, most) for most in MOST)), periods)
def test_within_its_bounds_nothing_is_changed(goal: tuple[float, ...], dt: float) -> None:
    """What keeps every bound is written as it is, to the last bit."""
    guard = Guard(CHANNELS, 0.0)
    for part in (0.2, 0.4, 0.6, 0.8, 1.0):
        wanted = tuple(rate * part for rate in goal)
        drive(guard, wanted, dt)
        assert guard.write(wanted, Motion.ALLOWED, dt) == wanted


@pytest.mark.parametrize("k", range(4))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_each_bound_is_where_it_is_said_to_be(k: int, sign: float) -> None:
    """Each channel alone: just within its speed and change is written, just beyond either is a fault that names it."""
    name = CHANNELS[k].name

    def alone(rate: float) -> tuple[float, ...]:
        return tuple(sign * rate if i == k else 0.0 for i in range(4))

    def at(rate: float) -> Guard:
        guard = Guard(CHANNELS, 0.0)
        drive(guard, alone(rate))
        return guard

    guard = at(MOST[k])
    assert guard.write(alone(MOST[k] * (1 + 1e-12)), Motion.ALLOWED, DT) == alone(MOST[k])  # rounding is taken away
    assert guard.fault == ""
    guard.write(alone(MOST[k] + 0.001 * CHANGE[k] * DT), Motion.ALLOWED, DT)
    assert guard.fault == (
        f"{name} was to be written as {sign * (MOST[k] + 0.001 * CHANGE[k] * DT):.3g} "
        f"{CHANNELS[k].unit}/s; its limit is {MOST[k]:.3g}."
    )

    step = CHANGE[k] * DT
    for by in (1.0, -1.0):
        guard = at(0.3)
        within, beyond = alone(0.3 + by * 0.999 * step), alone(0.3 + by * 1.1 * step)
        assert guard.write(within, Motion.ALLOWED, DT) == within
        guard = at(0.3)
        assert guard.write(beyond, Motion.ALLOWED, DT) == pytest.approx(alone(0.3 - step))
        assert guard.fault == (
            f"{name} was to be changed by {1.1 * CHANGE[k]:.3g} {CHANNELS[k].unit}/s^2; its limit is {CHANGE[k]:.3g}."
        )


@pytest.mark.parametrize("k", range(4))
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("motion", Motion)
def test_what_is_not_finite_is_a_fault_that_names_its_channel(k: int, bad: float, motion: Motion) -> None:
    """A rate that is not finite is never written: it latches a fault with its channel, also where nothing may move."""
    guard = Guard(CHANNELS, 0.0)
    drive(guard, HALF)
    wanted = tuple(bad if i == k else rate for i, rate in enumerate(HALF))
    before = guard.written
    after = guard.write(wanted, motion, DT)
    assert guard.fault == f"{CHANNELS[k].name} was to be written as a value that is not finite."
    assert keeps_bounds(before, after, DT)
    assert all(abs(is_) < abs(was) for was, is_ in zip(before, after, strict=True))


@given(st.tuples(*(st.floats(-most, most) for most in MOST)), periods)
def test_a_ramp_keeps_the_robots_direction_and_takes_v_over_a(start: tuple[float, ...], dt: float) -> None:
    """A ramp shrinks all channels alike, by no less than the slowest needs, and ends at exact zero."""
    guard = Guard(CHANNELS, 0.0)
    drive(guard, start, dt)
    start = guard.written
    needed = max(abs(rate) / change for rate, change in zip(start, CHANGE, strict=True))
    writes = [start]
    while any(writes[-1]):
        writes.append(guard.ramp(dt))
        assert keeps_bounds(writes[-2], writes[-1], dt)
        assert len(writes) < 400
    assert math.ceil(needed / dt - 1e-6) <= len(writes) - 1 <= math.ceil(needed / dt + 1e-6)
    part = [rates[2] / start[2] if start[2] else 0.0 for rates in writes]
    for rates, whole in zip(writes, part, strict=True):
        if abs(start[2]) > 1e-3:
            assert rates == pytest.approx(tuple(rate * whole for rate in start), abs=1e-12)


@given(st.tuples(*(st.floats(-most, most) for most in MOST)), st.integers(0, 10**9), st.floats(0.0, 0.17), periods)
def test_zero_within_v_over_a_of_letting_go(start: tuple[float, ...], seed: int, ramping: float, dt: float) -> None:
    """However long the command ramps, whatever is wanted meanwhile: zero after 0.6/3.5 s and a period, for ever."""
    chance = random.Random(seed)
    guard = Guard(CHANNELS, 0.0)
    drive(guard, start, dt)
    t, calm = 0.0, chance.random() < 0.5
    for _ in range(600):
        wanted = tuple(
            was + chance.uniform(-1.0, 1.0) * change * dt if not calm else was
            for was, change in zip(guard.written, CHANGE, strict=True)
        )
        wanted = tuple(max(-most, min(most, rate)) for rate, most in zip(wanted, MOST, strict=True))
        before = guard.written
        guard.write(wanted, Motion.RAMPING if t < ramping else Motion.NONE, dt)
        assert keeps_bounds(before, guard.written, dt)
        t += dt
        if t > STOP_S + dt:
            assert guard.written == ZERO
    assert guard.fault == ""


def test_a_ramp_of_the_command_is_left_alone_while_it_is_in_time() -> None:
    """While the command itself ramps to zero in time, what is wanted is what is written; past its time it is not."""
    for ramp_s, kept in ((0.4, True), (0.0, False)):
        guard = Guard(CHANNELS, ramp_s)
        assert guard.stop_s == pytest.approx(0.4 if kept else STOP_S)
        drive(guard, (0.3, 0.0, 0.0, 0.0))
        same = True
        for k in range(1, 81):
            wanted = 0.3 * (1 - k / 80)
            same &= guard.write((wanted, 0.0, 0.0, 0.0), Motion.RAMPING, DT)[0] == pytest.approx(wanted)
            if not same:
                break
        assert same is kept


def test_motion_begins_its_time_anew() -> None:
    """Time without motion counts from the last moment with it: a stop that is called off leaves nothing behind."""
    guard = Guard(CHANNELS, 0.0)
    drive(guard, (0.3, 0.0, 0.0, 0.0))
    for _ in range(50):
        for _ in range(10):  # 50 ms of holding on, again and again: more than stop_s in all
            assert guard.write((0.3, 0.0, 0.0, 0.0), Motion.RAMPING, DT)[0] == 0.3
        assert guard.write((0.3, 0.0, 0.0, 0.0), Motion.ALLOWED, DT)[0] == 0.3


def test_a_fault_is_latched_with_its_first_reason_until_reset() -> None:
    """After a fault all ramps to zero and stays there, whatever is wanted; a reset moves nothing and lets go of it."""
    guard = Guard(CHANNELS, 0.0)
    drive(guard, HALF)
    guard.latch("first")
    guard.latch("second")
    assert guard.fault == "first"
    for _ in range(35):
        guard.write(HALF, Motion.ALLOWED, DT)
    assert guard.written == ZERO
    assert guard.write(ZERO, Motion.ALLOWED, DT) == ZERO
    guard.write((math.nan, *HALF[1:]), Motion.NONE, DT)
    assert guard.fault == "first"
    guard.reset()
    assert guard.fault == ""
    assert guard.written == ZERO
    assert guard.write((0.01, 0.0, 0.0, 0.0), Motion.ALLOWED, DT) == (0.01, 0.0, 0.0, 0.0)


def test_a_restart_is_standstill_and_keeps_the_fault() -> None:
    """After a restart the robot is taken to stand still, with all its time; a fault is not forgotten."""
    guard = Guard(CHANNELS, 0.0)
    drive(guard, (0.3, 0.0, 0.0, 0.0))
    for _ in range(15):
        guard.write((0.3, 0.0, 0.0, 0.0), Motion.RAMPING, DT)
    guard.latch("why")
    guard.restart()
    assert guard.written == ZERO
    assert guard.fault == "why"
    guard.reset()
    drive(guard, (0.3, 0.0, 0.0, 0.0))
    for _ in range(15):
        assert guard.write((0.3, 0.0, 0.0, 0.0), Motion.RAMPING, DT)[0] == 0.3


def test_any_number_of_channels() -> None:
    """The guard knows no robot: one channel or nine, each has its own bounds."""
    for n in (1, 9):
        guard = Guard([Channel(f"c{k}", f"x{k}", "m", 1.0 + k, 2.0) for k in range(n)], 0.0)
        assert guard.stop_s == pytest.approx(n / 2.0)
        guard.write((0.01,) * n, Motion.ALLOWED, 0.01)
        assert guard.written == (0.01,) * n
        guard.write((*(0.0,) * (n - 1), math.nan), Motion.ALLOWED, 0.01)
        assert guard.fault.startswith(f"c{n - 1} ")


def test_writes_change_from_one_to_the_next() -> None:
    """Bounds on change are from write to write: two half steps reach as far as the sum of both, in any rhythm."""
    guard = Guard(CHANNELS, 0.0)
    times = [0.004, 0.001, 0.007, 0.002]
    rates = [0.0]
    for dt in times:
        rates.append(rates[-1] + 3.5 * dt)
        assert guard.write((rates[-1], 0.0, 0.0, 0.0), Motion.ALLOWED, dt)[0] == pytest.approx(rates[-1])
    assert guard.fault == ""
    assert all(later > earlier for earlier, later in pairwise(rates))


def test_every_channel_must_be_there() -> None:
    """Rates for too few channels are a mistake of the caller's, and raise; nothing is written."""
    rounded = CHANGE[0] * DT * (1.0 + 1e-7)  # a little too much, which is cut off
    for motion, first in product((Motion.ALLOWED, Motion.RAMPING), (0.0, rounded)):
        guard = Guard(CHANNELS, 0.0)
        with pytest.raises(ValueError, match="zip"):
            guard.write((first, 0.0), motion, DT)
        assert guard.written == ZERO


BINARY = Channel("rate", "joint", "rad", 5.0, 2.0)
"""A channel whose numbers are exact: at 0.5 s a period its change is 1.0."""


def test_rounding_is_a_millionth_of_a_change() -> None:
    """Just a millionth of a period's change past a bound is taken away; anything more is a fault."""
    guard = Guard([BINARY], 0.0)
    assert guard.write([-1.0], Motion.ALLOWED, 0.5) == (-1.0,)
    assert guard.write([1e-6], Motion.ALLOWED, 0.5) == (0.0,)
    assert guard.fault == ""
    guard.write([-1.0], Motion.ALLOWED, 0.5)
    guard.write([1.001e-6], Motion.ALLOWED, 0.5)
    assert guard.fault.startswith("rate was to be changed by 2 rad/s^2")


def test_full_speed_at_once_is_a_change_that_is_too_great() -> None:
    """What is at its speed limit but comes too suddenly is told as a change."""
    guard = Guard([BINARY], 0.0)
    guard.write([5.0], Motion.ALLOWED, 0.5)
    assert guard.fault == "rate was to be changed by 10 rad/s^2; its limit is 2."


def test_the_last_moment_to_brake() -> None:
    """What is wanted is written up to the last period in which a ramp is still in time, to the last bit."""
    guard = Guard([Channel("rate", "joint", "rad", 1.0, 2.0)], 0.0)
    for rate in (0.25, 0.5):
        guard.write([rate], Motion.ALLOWED, 0.125)
    assert guard.stop_s == 0.5
    written = [guard.write([0.5], Motion.RAMPING, 0.125)[0] for _ in range(5)]
    assert written == [0.5, 0.5, 0.25, 0.0, 0.0]


def test_before_motion_was_ever_allowed_nothing_moves() -> None:
    """A guard that has not been told that something may move writes zero, whatever is wanted, also after a restart."""
    guard = Guard([BINARY], 0.0)
    for _ in range(2):
        assert guard.write([0.5], Motion.RAMPING, 0.5) == (0.0,)
        guard.write([0.5], Motion.ALLOWED, 0.5)
        guard.restart()
