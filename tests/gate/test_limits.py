from __future__ import annotations

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
    for _ in range(20_000):
        if (v_c, w_c) == goal:
            break
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
    with pytest.raises(SetupError, match="dv_c"):
        Limits(dv_c=0.0)
    with pytest.raises(SetupError, match="v_c"):
        Limits(v_c=float("nan"))
