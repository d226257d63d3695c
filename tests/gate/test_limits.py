from __future__ import annotations

import math
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.errors import SetupError
from overreach.gate.limits import Limits, clamp_change, feasible_scale, limit_speed, slew
from overreach.types import Verdict

LIMITS = Limits()
commands = st.tuples(st.floats(-5, 5), st.floats(-5, 5))
fours = st.tuples(*[st.floats(-3, 3)] * 4)


@given(commands)
def test_speed_limit_keeps_the_direction(command: tuple[float, float]) -> None:
    """A command over the limit is shrunk as a whole: its direction stays, and no part passes its limit."""
    v_c, w_c, scale = limit_speed(*command, LIMITS)
    assert (v_c, w_c) == pytest.approx((command[0] * scale, command[1] * scale), abs=1e-12)
    assert abs(v_c) <= LIMITS.v_c * (1 + 1e-8)
    assert abs(w_c) <= LIMITS.w_c * (1 + 1e-8)
    assert scale == 1.0 or max(abs(v_c) / LIMITS.v_c, abs(w_c) / LIMITS.w_c) == pytest.approx(1.0)


@given(commands, commands, st.floats(0.001, 0.02))
def test_slew_is_bounded_and_straight(now: tuple[float, float], goal: tuple[float, float], dt: float) -> None:
    """The command moves straight towards its goal, by at most a_max dt, and gets there."""
    v_c, w_c, limited = slew(now, goal, LIMITS, dt)
    assert abs(v_c - now[0]) <= LIMITS.dv_c * dt * (1 + 1e-8)
    assert abs(w_c - now[1]) <= LIMITS.dw_c * dt * (1 + 1e-8)
    cross = (v_c - now[0]) * (goal[1] - now[1]) - (w_c - now[1]) * (goal[0] - now[0])
    assert cross == pytest.approx(0.0, abs=1e-9)
    if not limited:
        assert (v_c, w_c) == goal
    periods = max(abs(goal[0] - now[0]), abs(goal[1] - now[1])) / (2.5 * dt)
    for _ in range(math.ceil(periods) + 1):
        v_c, w_c, _ = slew((v_c, w_c), goal, LIMITS, dt)
    assert (v_c, w_c) == goal


@given(commands, st.floats(0.001, 0.02))
def test_a_ramp_to_zero_keeps_the_direction(now: tuple[float, float], dt: float) -> None:
    """While it ramps down, the command keeps pointing the same way."""
    v_c, w_c, _ = slew(now, (0.0, 0.0), LIMITS, dt)
    assert v_c * now[1] == pytest.approx(w_c * now[0], abs=1e-9)
    assert v_c * now[0] >= 0.0


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
    """0.4 m/s, 0.4 rad/s, 2.5 m/s^2, 2.5 rad/s^2; the command's longest ramp is v/a."""
    assert (LIMITS.v_c, LIMITS.w_c, LIMITS.dv_c, LIMITS.dw_c) == (0.4, 0.4, 2.5, 2.5)
    assert LIMITS.ramp_s == pytest.approx(0.16)
    assert Limits(0.5, 0.4, 1.0, 2.0).ramp_s == 0.5
    assert Limits(0.5, 0.6, 1.0, 0.25).ramp_s == pytest.approx(2.4)


def test_what_is_just_at_a_limit_is_as_it_is() -> None:
    """A command or change at its limit, give or take 1e-9 of it, is not scaled; a part in 1e8 more is."""
    one = Limits(1.0, 1.0, 1.0, 1.0)
    for value in (1.0, 1.0 - 5e-10, 1.0 + 5e-10, 1.0 + 1e-9, -1.0 - 1e-9):
        assert limit_speed(value, 0.0, one) == (value, 0.0, 1.0)
        assert limit_speed(0.0, value, one) == (0.0, value, 1.0)
        assert slew((0.0, 0.0), (value, 0.0), one, 1.0) == (value, 0.0, False)
        assert slew((0.0, 0.0), (0.0, value), one, 1.0) == (0.0, value, False)
    for value in (1.0 + 1e-8, -1.0 - 1e-8):
        assert limit_speed(value, 0.0, one)[2] < 1.0
        assert slew((0.0, 0.0), (value, 0.0), one, 1.0)[2]


def test_slew_goes_part_of_the_way() -> None:
    """From (0.5, -0.25) to (2.5, 0.75) in a period that allows a change of 0.5: a quarter of the way, both parts."""
    one = Limits(9.0, 9.0, 1.0, 1.0)
    assert slew((0.5, -0.25), (2.5, 0.75), one, 0.5) == (1.0, 0.0, True)


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
