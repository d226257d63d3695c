"""The law `side`: a drive along the base's way, an arm across it, and a base that swings before the arm ends."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from overreach.arm.mount import Mount
from overreach.errors import SetupError
from overreach.law.authority import ee_velocity
from overreach.law.blend import rise_smoothstep
from overreach.law.body import check_fits
from overreach.law.laws import Exact
from overreach.law.side import STRAIGHT, Alongside, Side, side
from overreach.model.planar import planar
from overreach.testing.law import check_law
from tests.strategies import speeds

ENDS = (0.2, 0.65, 0.1, 0.06)
D, Q = ENDS[2], ENDS[3]
MOST = 0.4
lengths = st.floats(ENDS[0], ENDS[1])
across = st.sampled_from((-0.5 * math.pi, 0.5 * math.pi))
offsets = st.floats(-0.1, 0.1)
TOPS = (0.3, 0.6)


@settings(max_examples=1_000)
@given(
    lengths, st.floats(-0.1, 0.1), speeds, speeds, across, offsets, offsets, st.floats(-0.5, 0.5), st.floats(-1.0, 1.0),
    st.booleans(),
)  # fmt: skip
def test_the_hand_moves_as_commanded(
    l: float,
    psi: float,
    u_r: float,
    u_t: float,
    yaw: float,
    s_x: float,
    s_y: float,
    w_c: float,
    steer: float,
    cut: bool,
) -> None:
    """Base and arm together give s u to 1e-9, however the base swings, turns or steers; the arm does not sweep."""
    mount = Mount(s_x, s_y, yaw).three
    tops = TOPS if cut else None
    mu, sigma, v_b, w_b, v_m, w_m, s = side(l, psi, u_r, u_t, rise_smoothstep, ENDS, mount, MOST, 1.0, w_c, steer, tops)
    size = 1.0 + abs(v_b) + abs(w_b)
    assert ee_velocity(l, psi, v_b, w_b, v_m, w_m, mount) == pytest.approx((s * u_r, s * u_t), abs=1e-9 * size)
    assert abs(w_m) <= 1e-9 * size
    assert 0.0 <= mu <= 1.0
    assert 0.0 <= s <= 1.0
    assert sigma == 1.0


@given(st.floats(0.0, 0.5 * math.pi), st.floats(0.01, 1.0), st.booleans(), st.booleans(), across)
def test_any_angle_turns_to_nothing_before_the_end(
    angle: float, speed: float, inward: bool, left: bool, yaw: float
) -> None:
    """On a straight line the angle a between the hand's way and the base's is a_0 - pi/d times the integral of mu.

    So it is 0 before L, d further, at any speed: da/dl does not depend on it. Integrated by the law itself.
    """
    out, turn = (-1.0 if inward else 1.0), (1.0 if left else -1.0)
    a, l = angle, ENDS[0] + Q + D if inward else ENDS[1] - Q - D
    begin = l
    for _ in range(4000):
        u_r, u_t = out * speed * math.sin(a), turn * speed * math.cos(a)
        *_, v_m, _, s = side(l, 0.0, u_r, u_t, rise_smoothstep, ENDS, (0.0, 0.0, yaw), MOST, turn)
        assert s == 1.0
        dt = 2e-4 / max(abs(v_m), 1e-3)
        l += 0.5 * dt * v_m
        mid = side(l, 0.0, u_r, u_t, rise_smoothstep, ENDS, (0.0, 0.0, yaw), MOST, turn)
        l += 0.5 * dt * v_m
        a += out * turn * mid[3] * dt
        gone = abs(l - begin)
        assert a == pytest.approx(angle - math.pi * gone / D * integral(gone / D), abs=5e-3)
        if a <= 0.0 or gone >= D:
            break
    assert a <= 5e-3


def integral(x: float) -> float:
    """Return the mean of the smoothstep over its first part x."""
    return x**2 - 0.5 * x**3


def test_the_free_part_is_the_arms() -> None:
    """Between the bands the base stands still for what lies along the arm, and takes all of the rest at once."""
    for l in (0.37, 0.42, 0.48):
        for yaw, way in ((-0.5 * math.pi, 1.0), (0.5 * math.pi, -1.0)):
            reach = side(l, 0.0, 0.1, 0.0, rise_smoothstep, ENDS, (0.0, 0.0, yaw), MOST)
            assert reach[2:4] == (0.0, 0.0)
            along = side(l, 0.0, 0.0, 0.2, rise_smoothstep, ENDS, (0.0, 0.0, yaw), MOST)
            assert along[2:5] == pytest.approx((way * 0.2, 0.0, 0.0), abs=1e-15)


@given(st.floats(0.0, 1.0), speeds, speeds)
def test_the_hand_waits_at_the_end_and_nowhere_else(part: float, u_r: float, u_t: float) -> None:
    """Its speed outward is at most (1 - f)/f of the greatest; 0 at the end; all of it inward, and along the way."""
    l = ENDS[1] - Q + part * Q
    f = rise_smoothstep(l - ENDS[1] + 0.5 * Q, Q)
    s = side(l, 0.0, u_r, u_t, rise_smoothstep, ENDS, (0.0, 0.0, -0.5 * math.pi), MOST)[6]
    if u_r <= 0.0:
        assert s == 1.0
    else:
        assert s * u_r * f <= (1.0 - f) * MOST * (1.0 + 1e-9)
    assert side(l, 0.0, 0.0, u_t, rise_smoothstep, ENDS, (0.0, 0.0, -0.5 * math.pi), MOST)[6] == 1.0
    assert side(ENDS[1] - Q, 0.0, u_r, u_t, rise_smoothstep, ENDS, (0.0, 0.0, -0.5 * math.pi), MOST)[6] == 1.0


@given(lengths, speeds, speeds, st.floats(-1.0, 1.0))
def test_a_swing_is_cut_to_what_the_base_can(l: float, u_r: float, u_t: float, steer: float) -> None:
    """|w_b| and |v_b| stay within their limits as long as the hand's own speed does; the hand still goes its way."""
    v_max, w_max = TOPS
    split = side(l, 0.0, u_r, u_t, rise_smoothstep, ENDS, (0.02, 0.0, -0.5 * math.pi), MOST, 1.0, 0.0, steer, TOPS)
    assert abs(split[3]) <= w_max * (1.0 + 1e-12)
    assert l * abs(split[3]) <= v_max * (1.0 + 1e-9)  # let go, it can still be driven
    if abs(u_t) < v_max:
        assert abs(split[2]) <= v_max * (1.0 + 1e-9)


def test_steering_ends_at_mid_reach() -> None:
    """On a straight line l and the angle go to (mid, 0) with a double eigenvalue: no way past it, from any side."""
    steering = Alongside(0.2, 0.42, 50.0)
    for y in (-0.15, 0.15):
        a, away = 0.0, y
        for _ in range(40_000):
            kappa = steering.steer(0.42 + away, math.sin(a), math.cos(a))
            away += 1e-4 * math.sin(a)
            a -= 1e-4 * math.cos(a) * kappa
            assert away * y >= -1e-6
        assert abs(away) < 1e-4 * abs(y) + 1e-6
        assert abs(a) < 1e-3


@given(st.floats(-0.05, 0.05), across, st.booleans(), st.floats(0.0, 0.5 * math.pi), st.booleans())
def test_the_swing_itself_never_draws_the_hand_out(
    s_x: float, yaw: float, inward: bool, angle: float, other: bool
) -> None:
    """A hand that waits while the base swings by what is left does not pass the arm's end, in either sense."""
    mount = Mount(s_x, 0.0, yaw).three
    out, turn = (-1.0 if inward else 1.0), (-1.0 if other else 1.0)
    l, a, v = (ENDS[0] + 0.15 if inward else ENDS[1] - 0.15), angle, 0.3
    for _ in range(20_000):
        u_r, u_t = out * v * math.sin(a), turn * v * math.cos(a)
        *_, w_b, v_m, _, _ = side(l, 0.0, u_r, u_t, rise_smoothstep, ENDS, mount, MOST, turn, tops=(0.3, 0.2))
        l += 2e-3 * v_m
        a += 2e-3 * out * turn * w_b
        assert ENDS[0] - 1e-3 <= l <= ENDS[1] + 1e-3
        if a <= 0.0 or (abs(w_b) < 1e-3 and a < 1e-2):
            break


def test_straight_out_swings_the_way_that_draws_the_arm_in() -> None:
    """Where the way says nothing, the sense is the one in which the arm's end does not go out for the swing."""
    for s_x in (-0.02, 0.02):
        for yaw in (-0.5 * math.pi, 0.5 * math.pi):
            for l, u_r in ((ENDS[1] - 0.5 * Q, 0.2), (ENDS[0] + 0.5 * Q, -0.2)):
                mount = Mount(s_x, 0.0, yaw).three
                *_, w_b, v_m, _, s = side(l, 0.0, u_r, 0.0, rise_smoothstep, ENDS, mount, MOST)
                assert w_b != 0.0
                assert (v_m - s * u_r) * u_r <= 0.0


def test_side_conforms() -> None:
    """It keeps what every law promises, on an arm to the left, to the right, and beside its axle."""
    for mount in (Mount(0.0, 0.0, 0.5 * math.pi), Mount(0.0, 0.0, -0.5 * math.pi), Mount(-0.02, 0.05, -1.5)):
        check_law(Side(), planar(mount=mount))


def test_hardly_across_is_scaled() -> None:
    """Where the arm points along the base's way, the drive cannot help: the command goes to 0, and v_b with it."""
    last = 1.0
    for sn in (STRAIGHT, 0.1, 0.01, 0.0):
        *_, s = found = side(0.4, 0.0, 0.1, 0.2, rise_smoothstep, ENDS, (0.0, 0.0, -math.asin(sn)), MOST)
        assert s <= last
        assert abs(found[2]) <= 0.2 / STRAIGHT + 1e-9
        last = s
    assert last == 0.0


def test_laws_are_for_their_arms() -> None:
    """`side` on an arm that sweeps is refused with the reason, as others are on one that does not."""
    with pytest.raises(SetupError, match="the law 'side' is for arms that cannot move their hand about the shoulder"):
        check_fits(Side, planar())
    check_fits(Exact, planar())
