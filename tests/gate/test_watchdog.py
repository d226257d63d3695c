from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.gate.watchdog import AWAY_S, CATCH_UP_S, Watchdog
from overreach.types import Channel, Takeover

PERIOD = 0.005
CHANNELS = (
    Channel("v", "x", "m", 0.6, 3.5),
    Channel("w", "yaw", "rad", 2.0, 12.0),
    Channel("dq", "q", "rad", 3.0, 20.0),
)
FULL = (0.6, -1.0, 1.5)
LONGEST_S = 0.6 / 3.5


def moving(rates: tuple[float, ...] = FULL, at: float = 10.0) -> Watchdog:
    """Return one whose loop has written `rates` at `at` [s]."""
    dog = Watchdog(CHANNELS, PERIOD)
    assert dog.take(rates, at, at + 2 * PERIOD, 0) == rates
    return dog


rates = st.tuples(*(st.floats(-c.rate_max, c.rate_max) for c in CHANNELS))


@given(st.lists(st.tuples(rates, st.floats(1e-4, 2 * PERIOD - 1e-6)), min_size=1, max_size=30))
def test_what_comes_in_time_is_passed_on(writes: list[tuple[tuple[float, ...], float]]) -> None:
    """Writes that are less than two periods apart pass unchanged, to the bit, and there is nothing else to write."""
    dog, now = Watchdog(CHANNELS, PERIOD), 10.0
    for wanted, gap in writes:
        assert dog.take(wanted, now, now + 2 * PERIOD, 0) == wanted
        assert dog.written == wanted
        assert dog.takeover is None
        assert dog.tick(now + 0.999 * gap) is None
        now += gap


@given(rates, st.lists(st.floats(1e-5, PERIOD), min_size=200, max_size=200), st.floats(0.0, PERIOD))
def test_past_the_deadline_it_ramps_along_the_last_rates(
    wanted: tuple[float, ...], gaps: list[float], late: float
) -> None:
    """From the deadline on: all channels by one fraction, linearly in time, to zero after the longest v/a."""
    dog = moving(wanted)
    due, now = 10.0 + 2 * PERIOD, 10.0 + 2 * PERIOD + late
    ramp_s = max(abs(rate) / c.change_max for rate, c in zip(wanted, CHANNELS, strict=True))
    for gap in (*gaps, *[PERIOD] * 40):
        written = dog.tick(now)
        if written is None:
            assert dog.resting
            break
        left = max(0.0, 1.0 - (now - due) / ramp_s) if ramp_s else 0.0
        for rate, was in zip(written, wanted, strict=True):
            assert abs(rate - left * was) <= 1e-9
        assert dog.takeover == Takeover(written, now - 10.0 > AWAY_S)
        now += gap
    assert dog.resting


def test_at_rest_within_v_over_a_and_a_tick() -> None:
    """Called once a period from the deadline on, it writes zero at most v/a and a tick after the deadline."""
    dog, due = moving(), 10.0 + 2 * PERIOD
    assert dog.wakes == due
    last = 0.0
    for _ in range(1000):
        if dog.resting:
            break
        last = dog.wakes
        assert dog.tick(last) is not None
    assert dog.resting
    assert 0.0 < last - due <= LONGEST_S + PERIOD + 1e-9
    assert dog.wakes == math.inf


@given(
    st.lists(
        st.tuples(rates, st.floats(1e-4, 0.3), st.booleans(), st.booleans(), st.sampled_from([0.0, math.nan])),
        min_size=1,
        max_size=40,
    )
)
def test_no_order_of_writes_and_silences_is_a_step(
    acts: list[tuple[tuple[float, ...], float, bool, bool, float]],
) -> None:
    """Any writes, at any times, after any silences, armed or not, with values that are not finite: once it has ramped,
    what it writes keeps the accelerations of one period, and of the time that passed where that is longer.
    """
    dog, now, arms = Watchdog(CHANNELS, PERIOD), 10.0, 0
    written = [(now, dog.written, False)]

    def note(own: bool) -> None:
        written.append((now, dog.written, own))

    for wanted, gap, arm, looks, bad in acts:
        arms += arm
        own = dog.takeover is not None
        dog.take(tuple(rate + bad for rate in wanted), now, now + 2 * PERIOD, arms)
        note(own)
        end = now + gap
        while looks and now + PERIOD < end:
            now += PERIOD
            dog.tick(now)
            note(True)
        now = end
    for (before, was, _), (after, is_, own) in pairwise(written):
        for rate, old, c in zip(is_, was, CHANNELS, strict=True):
            assert math.isfinite(rate)
            assert abs(rate) <= c.rate_max
            if own:
                span = max(PERIOD, min(after - before, CATCH_UP_S))
                assert abs(rate - old) <= c.change_max * span * (1 + 1e-9)


@given(st.floats(2 * PERIOD, AWAY_S - 0.001))
def test_after_a_short_silence_it_goes_on_from_what_stands(silence: float) -> None:
    """A write within 100 ms is carried out, from the rates that stand, and then the next ones pass unchanged."""
    dog = moving()
    now = 10.0 + 2 * PERIOD
    while now < 10.0 + silence:
        dog.tick(now)
        now += PERIOD
    now = 10.0 + silence
    stands = dog.written
    wanted = tuple(rate + 0.9 * c.change_max * PERIOD * (1 if k else -1) for k, (rate, c) in
                   enumerate(zip(stands, CHANNELS, strict=True)))  # fmt: skip
    assert dog.take(wanted, now, now + 2 * PERIOD, 0) == wanted
    assert dog.takeover is None


def test_a_write_too_far_away_is_reached_in_steps_along_a_straight_line() -> None:
    """After a ramp of its own, rates that one period cannot reach are approached by one fraction of the way."""
    dog = moving()
    now = 10.0 + 2 * PERIOD
    for _ in range(12):
        dog.tick(now)
        now += PERIOD
    stands = dog.written
    first = dog.take(FULL, now, now + 2 * PERIOD, 0)
    parts = [(is_ - was) / (goal - was) for is_, was, goal in zip(first, stands, FULL, strict=True)]
    assert max(parts) - min(parts) < 1e-9
    assert 0.0 < parts[0] < 1.0
    steps = [abs(is_ - was) / (c.change_max * PERIOD) for is_, was, c in zip(first, stands, CHANNELS, strict=True)]
    assert abs(max(steps) - 1.0) < 1e-9
    assert dog.takeover == Takeover(first, False)


@given(st.floats(AWAY_S + 1e-6, 5.0), rates)
def test_after_a_long_silence_only_arming_counts(silence: float, wanted: tuple[float, ...]) -> None:
    """More than 100 ms after the last write to a moving robot nothing counts, until it is armed once more."""
    dog = moving()
    now = 10.0 + silence
    for _ in range(60):
        dog.take(wanted, now, now + 2 * PERIOD, 0)
        assert dog.takeover
        assert dog.takeover.latched
        now += PERIOD
    assert dog.resting
    assert dog.take(wanted, now, now + 2 * PERIOD, 0) == (0.0, 0.0, 0.0)
    small = tuple(0.5 * c.change_max * PERIOD for c in CHANNELS)
    assert dog.take(small, now, now + 2 * PERIOD, 1) == small
    assert dog.takeover is None


def test_exactly_100_ms_is_in_time() -> None:
    """The latch closes after 100 ms, not at them."""
    assert AWAY_S == 0.1
    one, other = moving(at=0.0), moving(at=0.0)
    one.tick(AWAY_S)
    assert not one.latched
    other.tick(math.nextafter(AWAY_S, math.inf))
    assert other.latched


def test_what_one_period_can_just_reach_is_reached() -> None:
    """After a ramp of its own, rates that one period of full acceleration leads to are not short of it."""
    dog = moving()
    dog.tick(10.0 + 2 * PERIOD)  # it takes over, and nothing has changed yet
    assert dog.takeover == Takeover(FULL, False)
    dog.halt()
    whole = tuple(c.change_max * PERIOD for c in CHANNELS)
    assert dog.take(whole, 10.012, 10.012 + 2 * PERIOD, 0) == whole
    assert dog.takeover is None


def test_an_older_arming_releases_nothing() -> None:
    """Only a count of armings that is greater than any before releases the latch: not an old one, nor the same."""
    dog = moving()
    dog.take(FULL, 10.005, 10.005 + 2 * PERIOD, 5)
    dog.tick(10.2)
    for arms in (5, 4, -1, 0):
        dog.take(FULL, 10.21, 10.21 + 2 * PERIOD, arms)
        assert dog.latched
    dog.take(FULL, 10.21, 10.21 + 2 * PERIOD, 6)
    assert not dog.latched


def test_a_clock_that_goes_back_changes_nothing() -> None:
    """At a time before that of the last ramp the rates stand: they are not led back to where they were."""
    dog = moving()
    dog.tick(10.0 + 2 * PERIOD)
    down = dog.tick(10.0 + 3 * PERIOD)
    assert down is not None
    assert abs(down[0]) < abs(FULL[0])
    assert dog.tick(10.0 + 2.5 * PERIOD) == down


@pytest.mark.parametrize("many", [2, 4])
def test_as_many_rates_as_channels(many: int) -> None:
    """After a ramp of its own, another number of rates than there are channels is an error of the caller."""
    dog = moving()
    dog.tick(10.0 + 2 * PERIOD)
    with pytest.raises(ValueError, match="zip"):
        dog.take((0.0,) * many, 10.011, 10.011 + 2 * PERIOD, 0)


def test_a_robot_at_rest_is_not_latched() -> None:
    """A loop that was away from a robot that stood still goes on: there is nothing that it has missed."""
    dog = moving((0.0, 0.0, 0.0))
    assert dog.tick(12.0) is None
    assert dog.take(FULL, 13.0, 13.0 + 2 * PERIOD, 0) == FULL
    assert dog.takeover is None


def test_a_loop_that_has_never_written_is_not_away() -> None:
    """Before the first write nothing moves, nothing is due and nothing is latched."""
    dog = Watchdog(CHANNELS, PERIOD)
    assert dog.wakes == math.inf
    assert dog.tick(1e9) is None
    assert dog.takeover is None
    assert dog.resting


def test_what_comes_past_its_time_does_not_count() -> None:
    """A write that lay about until its deadline is as good as none: it neither moves nor counts as a sign of life."""
    dog = moving()
    now = 10.0 + 2 * PERIOD + 0.001
    assert dog.take(FULL, now, now, 0) != FULL
    assert dog.takeover is not None
    dog.take(FULL, 10.0 + AWAY_S + 0.001, 10.05, 5)
    assert dog.latched
    still = Watchdog(CHANNELS, PERIOD)
    assert still.take(FULL, 5.0, 4.0, 0) == (0.0, 0.0, 0.0)
    assert still.takeover is None


def test_the_end_of_the_loop_is_a_ramp_at_once() -> None:
    """A loop that has ended is not waited for until its deadline; a deadline that has passed is not put off."""
    dog = moving()
    dog.end(10.001)
    assert dog.tick(10.001) == FULL
    assert dog.tick(10.003) != FULL
    late = moving()
    late.end(10.0 + 4 * PERIOD)
    first = late.tick(10.0 + 4 * PERIOD)
    assert first is not None
    assert abs(first[0] - FULL[0] * (1 - 2 * PERIOD / LONGEST_S)) < 1e-9


def test_a_halt_is_at_once() -> None:
    """A robot that was stopped or put back stands still: nothing is left to ramp."""
    dog = moving()
    dog.halt()
    assert dog.resting
    assert dog.tick(20.0) is None


def test_a_host_that_was_held_up_itself_makes_no_step() -> None:
    """However late it is called, one step of the ramp is at most the acceleration in CATCH_UP_S."""
    dog = moving()
    first = dog.tick(60.0)
    assert first is not None
    assert abs(first[0] - FULL[0] * (1 - CATCH_UP_S / LONGEST_S)) < 1e-9
