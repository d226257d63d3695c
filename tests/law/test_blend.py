from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.errors import SetupError, UnknownNameError
from overreach.law.blend import Blend, Smoothstep, Step, Tanh, rise_smoothstep, rise_step, rise_tanh
from overreach.plugs import load_blend
from tests.strategies import blends

distances = st.floats(-2.0, 2.0)


@given(blends, distances, distances)
def test_rises_from_arm_to_base(blend: Blend, one: float, other: float) -> None:
    """A blend rises from 0 to 1 and never falls."""
    low, high = sorted((one, other))
    assert 0.0 <= blend.rise(low, blend.k_l) <= blend.rise(high, blend.k_l) <= 1.0


@given(st.floats(1.0, 500.0), distances)
def test_tanh_is_the_papers(alpha: float, e: float) -> None:
    """The tanh blend equals 1/(1 + exp(-2 alpha e)), another form of (14a)."""
    assert rise_tanh(e, alpha) == pytest.approx(1.0 / (1.0 + math.exp(min(700.0, -2.0 * alpha * e))), abs=1e-12)


@given(st.floats(0.01, 1.0), distances)
def test_smoothstep_is_symmetric_with_compact_support(q: float, e: float) -> None:
    """Smoothstep is 0 below -q/2, 1 above q/2, and what arm and base get at e they swap at -e."""
    share = rise_smoothstep(e, q)
    assert share + rise_smoothstep(-e, q) == pytest.approx(1.0, abs=1e-12)
    if e <= -q / 2:
        assert share == pytest.approx(0.0, abs=1e-15)
    if e >= q / 2:
        assert share == pytest.approx(1.0, abs=1e-15)


@given(st.floats(0.01, 1.0))
def test_smoothstep_is_smooth(q: float) -> None:
    """The slope of smoothstep is 0 at both ends of its band and 1.5/q in the middle."""
    h = 1e-6 * q
    for e, slope in ((-q / 2, 0.0), (q / 2, 0.0), (0.0, 1.5 / q)):
        assert (rise_smoothstep(e + h, q) - rise_smoothstep(e - h, q)) / (2 * h) == pytest.approx(slope, abs=1e-4 / q)


def test_step_favours_the_arm_at_the_limit() -> None:
    """At the limit itself the hard switch still gives the motion to the arm: (12) says l > L_max."""
    assert rise_step(0.0, 1.0) == 0.0
    assert rise_step(1e-12, 1.0) == 1.0


@given(st.floats(5.0, 200.0))
def test_width_of_tanh_holds_98_per_cent(alpha: float) -> None:
    """The transition width Q of tanh, ln(99)/alpha, goes from 1 % to 99 %."""
    blend = Tanh(alpha, alpha)
    assert blend.rise(-blend.width_l / 2, alpha) == pytest.approx(0.01, abs=1e-12)
    assert blend.rise(blend.width_l / 2, alpha) == pytest.approx(0.99, abs=1e-12)


@pytest.mark.parametrize("bad", [0.0, -1.0, math.nan, math.inf])
def test_widths_must_be_positive(bad: float) -> None:
    """A width that is not a finite number above 0 is an error at set-up, not a blend."""
    with pytest.raises(SetupError, match="> 0"):
        Tanh(bad)
    with pytest.raises(SetupError, match="> 0"):
        Smoothstep(0.1, bad)


def test_blends_by_name() -> None:
    """Every blend has a name, takes its own parameters, and an unknown name is met with the nearest."""
    assert load_blend("tanh", {"alpha": 10.0, "beta": 20.0}) == Tanh(10.0, 20.0)
    assert load_blend("smoothstep", {"q_l": 0.1, "q_psi": 0.2}) == Smoothstep(0.1, 0.2)
    assert load_blend("step") == Step()
    with pytest.raises(UnknownNameError, match="'smoothstep'"):
        load_blend("smothstep")
    with pytest.raises(UnknownNameError, match=r"unknown parameter of the blend tanh 'alfa'\. Did you mean 'alpha'\?"):
        load_blend("tanh", {"alfa": 10.0})
