from __future__ import annotations

import math
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import astuple

from overreach.errors import SetupError
from overreach.gate.limits import Limits, clamp_change, feasible_scale, limit_speed, slew, within
from overreach.types import Twist
from overreach.verdicts import Verdict

LIMITS = Limits()
NAMES = ("v_x", "v_y", "v_z", "w_x", "w_y", "w_z")
commands = st.builds(Twist, *[st.floats(-5, 5)] * 6)
fours = st.tuples(*[st.floats(-3, 3)] * 4)


def worst(twist: Twist, most: tuple[float, float, float]) -> float:
    """Return how many times its bound the worst part is: along the ground, up and down, turning."""
    along, up, turning = most
    return max(
        math.hypot(twist.v_x, twist.v_y) / along,
        abs(twist.v_z) / up,
        math.hypot(twist.w_x, twist.w_y, twist.w_z) / turning,
    )


def change(one: Twist, other: Twist) -> Twist:
    return Twist(*[b - a for a, b in zip(astuple(one), astuple(other), strict=True)])


MOST, FASTEST = (LIMITS.v_c, LIMITS.v_z, LIMITS.w_c), (LIMITS.dv_c, LIMITS.dv_z, LIMITS.dw_c)


@given(commands)
def test_speed_limit_keeps_the_direction(command: Twist) -> None:
    """A command over the limit is shrunk as a whole: its direction stays, and no part passes its limit."""
    twist, scale = limit_speed(command, LIMITS)
    assert astuple(twist) == pytest.approx([part * scale for part in astuple(command)], abs=1e-12)
    assert worst(twist, MOST) <= 1.0 + 1e-8
    assert scale == 1.0 or worst(twist, MOST) == pytest.approx(1.0)


@given(commands, commands, st.floats(0.001, 0.02))
def test_slew_is_bounded_and_straight(now: Twist, goal: Twist, dt: float) -> None:
    """The command moves straight towards its goal, by at most a_max dt, and gets there."""
    twist, limited = slew(now, goal, LIMITS, dt)
    bounds = tuple(most * dt for most in FASTEST)
    assert worst(change(now, twist), (bounds[0], bounds[1], bounds[2])) <= 1.0 + 1e-8
    way, whole = astuple(change(now, twist)), astuple(change(now, goal))
    for k in range(6):
        for j in range(k):
            assert way[k] * whole[j] - way[j] * whole[k] == pytest.approx(0.0, abs=1e-9)
    if not limited:
        assert twist == goal
    for _ in range(math.ceil(worst(change(now, goal), (bounds[0], bounds[1], bounds[2]))) + 1):
        twist, _ = slew(twist, goal, LIMITS, dt)
    assert twist == goal


@given(commands, st.floats(0.001, 0.02))
def test_a_ramp_to_zero_keeps_the_direction(now: Twist, dt: float) -> None:
    """While it ramps down, the command keeps pointing the same way."""
    twist, _ = slew(now, Twist(), LIMITS, dt)
    was, is_ = astuple(now), astuple(twist)
    for k in range(6):
        assert is_[k] * was[k] >= 0.0
        for j in range(k):
            assert is_[k] * was[j] == pytest.approx(is_[j] * was[k], abs=1e-9)


def test_the_speed_along_the_ground_is_the_same_in_every_direction() -> None:
    """A diagonal is as fast as a straight line: v_c limits the hand's speed, not its parts."""
    twist, scale = limit_speed(Twist(0.4, 0.4), LIMITS)
    assert math.hypot(twist.v_x, twist.v_y) == pytest.approx(0.4)
    assert scale == pytest.approx(1.0 / math.sqrt(2.0))


@given(fours, fours)
def test_feasible_scale_is_feasible_and_greatest(wanted: tuple[float, ...], happening: tuple[float, ...]) -> None:
    """The scale keeps every limit that any scale keeps, and none greater would."""
    fastest, change = (1.0, 2.0, 3.0, 3.0), (0.5, 1.0, 2.0, 2.0)

    def keeps(scale: float, slack: float) -> bool:
        return all(
            abs(scale * rate) <= most + slack and (abs(rate) <= 1e-9 or abs(scale * rate - was) <= step + slack)
            for rate, was, most, step in zip(wanted, happening, fastest, change, strict=True)
        )

    scale, verdict = feasible_scale(wanted, happening, fastest, change)
    assert 0.0 <= scale <= 1.0
    some = [k / 200 for k in range(201) if keeps(k / 200, 0.0)]
    if some:
        assert keeps(scale, 1e-6)
        assert scale >= some[-1] - 1e-9
    if scale < 1.0 - 1e-9:
        assert verdict in (Verdict.SPEED, Verdict.ACCELERATION)


@given(st.floats(-9, 9), st.floats(-9, 9), st.floats(0, 3))
def test_clamp_is_the_last_word(wanted: float, happening: float, change: float) -> None:
    """A clamped rate is within its change, and is the wanted one where that is."""
    got = clamp_change(wanted, happening, change)
    assert abs(got - happening) <= change * (1 + 1e-12) + 1e-12
    if abs(wanted - happening) <= change:
        assert got == wanted


def test_limits_are_checked() -> None:
    """A limit that is not a finite number above 0 is refused."""
    with pytest.raises(AttributeError):
        LIMITS.v_c = 9.0  # type: ignore[misc]
    with pytest.raises(SetupError, match="w_c"):
        Limits(w_c=-0.1)
    with pytest.raises(SetupError, match="dv_c"):
        Limits(dv_c=0.0)
    with pytest.raises(SetupError, match="v_c"):
        Limits(v_c=float("nan"))


def test_the_default_limits() -> None:
    """0.4 m/s, 0.4 rad/s, 2.5 m/s^2, 2.5 rad/s^2, up and down 0.1 m/s, 0.625 m/s^2; the longest ramp is v/a."""
    assert (LIMITS.v_c, LIMITS.w_c, LIMITS.dv_c, LIMITS.dw_c) == (0.4, 0.4, 2.5, 2.5)
    assert (LIMITS.v_z, LIMITS.dv_z) == (0.1, 0.625)
    assert LIMITS.ramp_s == pytest.approx(0.16)
    assert Limits(v_z=0.3, dv_z=0.1).ramp_s == pytest.approx(3.0)
    assert Limits(0.5, 0.4, 1.0, 2.0).ramp_s == 0.5
    assert Limits(0.5, 0.6, 1.0, 0.25).ramp_s == pytest.approx(2.4)


def test_what_is_just_at_a_limit_is_as_it_is() -> None:
    """A command or change at its limit, give or take 1e-9 of it, is not scaled; a part in 1e8 more is."""
    one = Limits(*[1.0] * 6)
    for value in (1.0, 1.0 - 5e-10, 1.0 + 5e-10, 1.0 + 1e-9, -1.0 - 1e-9):
        for part in NAMES:
            twist = Twist(**{part: value})
            assert limit_speed(twist, one) == (twist, 1.0)
            assert slew(Twist(), twist, one, 1.0) == (twist, False)
    for value in (1.0 + 1e-8, -1.0 - 1e-8):
        for part in NAMES:
            twist = Twist(**{part: value})
            assert limit_speed(twist, one)[1] < 1.0
            assert slew(Twist(), twist, one, 1.0)[1]


def test_slew_goes_part_of_the_way() -> None:
    """From (0.5, -0.25) to (2.5, 0.75) in a period that allows a change of 0.5: a quarter of the way, all parts."""
    one = Limits(9.0, 9.0, 1.0, 1.0, 9.0, 1.0)
    for first, second in (("v_x", "w_z"), ("v_z", "w_x"), ("w_y", "v_y")):
        now, goal = Twist(**{first: 0.5, second: -0.25}), Twist(**{first: 2.5, second: 0.75})
        assert slew(now, goal, one, 0.5) == (Twist(**{first: 1.0}), True)


def test_nothing_in_the_way_is_no_scale() -> None:
    """Where every limit is kept, the scale is 1 and the verdict MOVING, for rates of either sign and none."""
    for wanted in product((0.5, -0.5, 0.0), repeat=2):
        assert feasible_scale(wanted, wanted, (1.0, 1.0), (0.1, 0.1)) == (1.0, Verdict.MOVING)
        assert feasible_scale((1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (0.1, 0.1)) == (1.0, Verdict.MOVING)


def test_a_rate_that_is_none_binds_nothing() -> None:
    """A channel that nothing is wanted of has no say, whatever it is doing."""
    assert feasible_scale((0.5, 0.0), (0.5, 0.9), (1.0, 1.0), (0.1, 0.1)) == (1.0, Verdict.MOVING)
    assert feasible_scale((0.5, 1e-9), (0.5, 0.9), (1.0, 1.0), (0.1, 0.1)) == (1.0, Verdict.MOVING)
    assert feasible_scale((0.5, -1e-9), (0.5, 0.9), (1.0, 1.0), (0.1, 0.1)) == (1.0, Verdict.MOVING)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("k", [0, 1])
def test_each_limit_by_itself(sign: float, k: int) -> None:
    """Speed alone gives limit/|rate|; acceleration alone gives (was + change)/rate: SPEED and ACCELERATION."""

    def at(value: float) -> tuple[float, ...]:
        return tuple(value if i == k else 0.0 for i in range(2))

    assert feasible_scale(at(2.0 * sign), at(1.0 * sign), (1.0, 1.0), (9.0, 9.0)) == (0.5, Verdict.SPEED)
    just = (1.0 + 1e-9) * sign
    assert feasible_scale(at(just), at(just), (1.0, 1.0), (9.0, 9.0)) == (1.0, Verdict.MOVING)
    got = feasible_scale(at(0.5 * sign), at(0.125 * sign), (1.0, 1.0), (0.25, 0.25))
    assert got == (0.75, Verdict.ACCELERATION)
    assert feasible_scale(at(1.0), at(0.0), (2.0, 2.0), (1.0 - 1e-9,) * 2) == (1.0 - 1e-9, Verdict.MOVING)
    # Too fast to be reached in one period: as near as can be.
    assert feasible_scale(at(0.5 * sign), at(-1.0 * sign), (1.0, 1.0), (0.25, 0.25)) == (0.0, Verdict.ACCELERATION)
    assert feasible_scale(at(0.5 * sign), at(1.0 * sign), (1.0, 1.0), (0.25, 0.25)) == (1.0, Verdict.ACCELERATION)


def test_limits_that_cannot_all_be_kept_share_what_is_missing() -> None:
    """Where one channel needs a scale of at least 0.75 and another at most 0.25, it is 0.5."""
    assert feasible_scale((1.0, 1.0), (1.0, 0.0), (9.0, 9.0), (0.25, 0.25)) == (0.5, Verdict.ACCELERATION)
    assert feasible_scale((1.0, 0.5), (1.0, 0.0), (9.0, 9.0), (0.5, 0.25)) == (0.5, Verdict.ACCELERATION)


def test_no_change_is_worth_a_speed_limit() -> None:
    """Where one channel needs a scale of at least 0.9 and the speed of another allows 0.5, it is 0.5."""
    assert feasible_scale((2.0, 1.0), (0.9, 1.0), (1.0, 9.0), (0.25, 0.1)) == (0.5, Verdict.ACCELERATION)


@given(fours, fours)
def test_speed_limits_hold_at_any_scale_that_is_returned(
    wanted: tuple[float, ...], happening: tuple[float, ...]
) -> None:
    """Whatever the robot is doing, the scaled command keeps every speed limit."""
    fastest = (1.0, 2.0, 0.5, 3.0)
    scale, _ = feasible_scale(wanted, happening, fastest, (0.01, 0.02, 0.03, 0.5))
    assert all(abs(scale * rate) <= most * (1 + 1e-8) for rate, most in zip(wanted, fastest, strict=True))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_a_channel_owes_apart_from_the_command(sign: float) -> None:
    """At scale s a rate is s wanted + apart: apart takes from the limit ahead, or adds to it, and is not scaled."""

    def scale(wanted: float, was: float, apart: float, most: float = 1.0, change: float = 9.0) -> tuple[float, Verdict]:
        return feasible_scale((sign * wanted,), (sign * was,), (most,), (change,), (sign * apart,))

    assert scale(1.0, 0.0, 0.25) == (0.75, Verdict.SPEED)
    assert scale(0.5, 0.0, 0.75) == (0.5, Verdict.SPEED)
    assert scale(1.0, 0.0, -0.25) == (1.0, Verdict.MOVING)
    assert scale(1.25, 0.0, -0.25) == (1.0, Verdict.MOVING)
    assert scale(0.5, 0.0, 1.5) == (0.0, Verdict.SPEED)
    assert scale(0.5, 0.0, -1.5) == (1.0, Verdict.MOVING)  # a smaller scale would not help
    assert scale(1.0, 0.5, 0.25, change=0.25) == (0.5, Verdict.ACCELERATION)
    assert scale(1.0, 0.0, -0.5, change=0.25) == (0.75, Verdict.ACCELERATION)
    assert scale(0.5, 1.0, 0.5, change=0.0625) == (1.0, Verdict.MOVING)
    assert feasible_scale((0.0,), (0.0,), (1.0,), (9.0,), (sign * 5.0,)) == (1.0, Verdict.MOVING)
    assert scale(0.5, 0.5, 0.0, change=0.0) == (1.0, Verdict.MOVING)  # one scale alone is enough


@given(st.tuples(*[st.floats(-3, 3)] * 2), st.tuples(*[st.floats(-3, 3)] * 2), st.tuples(*[st.floats(-1, 1)] * 2))
def test_a_scale_that_keeps_all_is_found_beside_what_is_owed(
    wanted: tuple[float, ...], happening: tuple[float, ...], apart: tuple[float, ...]
) -> None:
    """If any scale keeps every limit of s wanted + apart, so does the one that is returned, and none greater."""
    fastest, change = (2.0, 2.5), (0.5, 1.0)

    def keeps(scale: float, slack: float) -> bool:
        return all(
            abs(scale * rate + own) <= most + slack
            and (abs(rate) <= 1e-9 or abs(scale * rate + own - was) <= step + slack)
            for rate, own, was, most, step in zip(wanted, apart, happening, fastest, change, strict=True)
        )

    scale, _ = feasible_scale(wanted, happening, fastest, change, apart)
    assert 0.0 <= scale <= 1.0
    some = [k / 100 for k in range(101) if keeps(k / 100, 0.0)]
    if some:
        assert keeps(scale, 1e-6)
        assert scale >= some[-1] - 1e-9


def test_every_channel_must_be_there() -> None:
    """Numbers for too few channels are a mistake of the caller's, and raise."""
    two, one = (0.5, 0.5), (0.5,)
    for case in ((one, two, two, two), (two, one, two, two), (two, two, one, two), (two, two, two, one)):
        with pytest.raises(ValueError, match="zip"):
            feasible_scale(*case)
    with pytest.raises(ValueError, match="zip"):
        feasible_scale(two, two, two, two, one)


@pytest.mark.parametrize("change", [0.0, 0.25])
def test_clamp_by_hand(change: float) -> None:
    """Held to within `change` of what happens, on both sides."""
    assert clamp_change(2.0, 0.5, change) == 0.5 + change
    assert clamp_change(-2.0, 0.5, change) == 0.5 - change
    assert clamp_change(0.5, 0.5, change) == 0.5


def test_within_says_what_needs_no_limit() -> None:
    """At its limits of speed and change a rate is within them, beyond either, up or down, it is not; nor is nan."""
    most, change, was = (1.0, 2.0), (0.25, 0.5), (0.75, -1.5)
    for rates in ((1.0, -2.0), (0.5, -1.0), (0.75, -1.5), (1.0, -1.0)):
        assert within(rates, was, most, change)
        assert within(tuple(-rate for rate in rates), tuple(-rate for rate in was), most, change)
    more = 1e-9
    for rates in ((1.0 + more, -1.5), (0.5 - more, -1.5), (0.75, -2.0 - more), (0.75, -1.0 + more), (math.nan, -1.5)):
        assert not within(rates, was, most, change)
        assert not within(tuple(-rate for rate in rates), tuple(-rate for rate in was), most, change)
    assert not within((0.75, math.nan), was, most, change)
    assert not within((1.5, 0.0), (1.5, 0.0), most, change)  # too fast, though it does not change
    assert not within((0.0, 0.0), was, most, change)  # changed too much, though it is slow
    with pytest.raises(ValueError, match="zip"):
        within((0.75,), was, most, change)
