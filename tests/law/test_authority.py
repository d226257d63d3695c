from __future__ import annotations

import math
import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from overreach.arm.mount import Mount
from overreach.law import authority
from overreach.law.blend import Blend, Smoothstep, Step, Tanh
from tests.laws import Bound, exact, paper, switch
from tests.strategies import MOUNT_FREE, WORKSPACE, bearings, blends, lengths, limits_of, mounts, speeds

TINY = 1e-12


def rigid_body_velocity(
    l: float, psi: float, mount: Mount, rates: tuple[float, float, float, float]
) -> tuple[float, float]:
    """Return the EE's velocity in the base frame, by the velocity of a point on a moving frame."""
    v_b, w_b, v_m, w_m = rates
    bearing = psi + mount.yaw
    p_x, p_y = mount.s_x + l * math.cos(bearing), mount.s_y + l * math.sin(bearing)
    return (
        v_b - w_b * p_y + v_m * math.cos(bearing) - l * w_m * math.sin(bearing),
        w_b * p_x + v_m * math.sin(bearing) + l * w_m * math.cos(bearing),
    )


def in_base_frame(u_r: float, u_t: float, bearing: float) -> tuple[float, float]:
    """Turn polar components into components of the base frame."""
    c, s = math.cos(bearing), math.sin(bearing)
    return u_r * c - u_t * s, u_r * s + u_t * c


@settings(max_examples=1_000)
@given(lengths, bearings, speeds, speeds, blends, mounts)
def test_exact_is_exact(l: float, psi: float, u_r: float, u_t: float, blend: Blend, mount: Mount) -> None:
    """The EE moves exactly as commanded, whatever share the base has and wherever the shoulder is."""
    check_exact(l, psi, u_r, u_t, blend, mount)


def test_exact_is_exact_in_10_000_random_cases() -> None:
    """The same to 1e-12 m/s in 10,000 cases drawn evenly, half of them with the shoulder off the base's centre."""
    chance = random.Random(712)
    for k in range(10_000):
        mount = (
            Mount(chance.uniform(-0.2, 0.3), chance.uniform(-0.2, 0.2), chance.uniform(-0.5, 0.5)) if k % 2 else Mount()
        )
        blend = (Tanh(chance.uniform(5, 200), chance.uniform(5, 200)), Smoothstep(), Step())[k % 3]
        check_exact(
            chance.uniform(0.42, 0.95),
            chance.uniform(-0.75, 0.75),
            chance.uniform(-0.4, 0.4),
            chance.uniform(-0.4, 0.4),
            blend,
            mount,
        )


def check_exact(l: float, psi: float, u_r: float, u_t: float, blend: Blend, mount: Mount) -> None:
    split = exact(WORKSPACE, blend, mount).split(l, psi, u_r, u_t)
    got = rigid_body_velocity(l, psi, mount, (split.v_b, split.w_b, split.v_m, split.w_m))
    want = in_base_frame(u_r * split.scale, u_t * split.scale, psi + mount.yaw)
    assert math.dist(got, want) <= TINY
    if math.cos(psi + mount.yaw) > 0.5 and math.hypot(mount.s_x, mount.s_y) < 0.1:
        assert split.scale == 1.0


@settings(max_examples=1_000)
@given(lengths, bearings, speeds, speeds, blends)
def test_exact_gives_the_base_the_papers_shares(l: float, psi: float, u_r: float, u_t: float, blend: Blend) -> None:
    """With s = 0 the base gives mu u_r along r, the arm (1 - mu) u_r, and the arm's bearing rate is blended."""
    split = exact(WORKSPACE, blend).split(l, psi, u_r, u_t)
    assert split.v_b * math.cos(psi) == pytest.approx(split.mu * u_r, abs=TINY)
    assert split.v_m == pytest.approx((1.0 - split.mu) * u_r, abs=TINY)
    if split.mu == 0.0:
        assert split.w_b == pytest.approx(split.sigma * u_t / l, abs=TINY)
        assert split.w_m == pytest.approx((1.0 - split.sigma) * u_t / l, abs=TINY)


@settings(max_examples=1_000)
@given(lengths, bearings, speeds, speeds, blends, mounts)
def test_exact_is_the_closed_form(l: float, psi: float, u_r: float, u_t: float, blend: Blend, mount: Mount) -> None:
    """`exact` equals the equations of the design, written out by vectors and solved by trying both signs."""
    split = exact(WORKSPACE, blend, mount).split(l, psi, u_r, u_t)
    if split.scale < 1.0 or math.hypot(u_r, u_t) < 1e-6:
        return
    bearing = psi + mount.yaw
    r = (math.cos(bearing), math.sin(bearing))
    s = (mount.s_x, mount.s_y)
    p = (s[0] + l * r[0], s[1] + l * r[1])
    k_r, k_t = s[0] * r[1] - s[1] * r[0], l + s[0] * r[0] + s[1] * r[1]
    g = 1.0 if u_r >= 0.0 else -1.0
    u = in_base_frame(g * u_r, g * u_t, bearing)
    eta = math.atan2(u[1], u[0])
    far = math.hypot(*p)
    q = -(p[0] * math.sin(eta) - p[1] * math.cos(eta)) / far**2 + 2.0 * g * eta / far
    mu = blend.rise(l - WORKSPACE.l_max if g > 0.0 else WORKSPACE.l_min - l, blend.k_l)
    w_l = q * mu * u_r / r[0]
    found = []
    for sign in (1.0, -1.0):
        edge = psi - WORKSPACE.psi_max if sign > 0.0 else WORKSPACE.psi_min - psi
        sigma = blend.rise(edge, blend.k_psi)
        v_b = (mu * u_r - (1.0 - sigma) * w_l * k_r - sigma * u_t * k_r / k_t) / (r[0] + sigma * r[1] * k_r / k_t)
        d = u_t + v_b * r[1]
        w_des = (d - k_t * w_l) / l
        if w_des * sign >= -1e-12:
            w_m = (1.0 - sigma) * w_des
            found.append((v_b, (d - l * w_m) / k_t, (1.0 - mu) * u_r, w_m))
    got = (split.v_b, split.w_b, split.v_m, split.w_m)
    assert any(all(a == pytest.approx(b, abs=1e-9) for a, b in zip(got, one, strict=True)) for one in found)


@settings(max_examples=1_000)
@given(lengths, bearings, speeds, mounts, st.floats(0.05, 0.2), st.sampled_from([Tanh(), Smoothstep()]))
def test_exact_is_continuous_where_the_command_turns_back(
    l: float, psi: float, u_t: float, mount: Mount, speed: float, blend: Blend
) -> None:
    """As the command passes from just outward to just inward, the rates do not jump: no chattering there."""
    law = exact(WORKSPACE, blend, mount)
    u_t = math.copysign(speed, u_t)
    one, other = law.split(l, psi, 1e-9, u_t), law.split(l, psi, -1e-9, u_t)
    for rate in ("v_b", "w_b", "v_m", "w_m"):
        assert getattr(one, rate) == pytest.approx(getattr(other, rate), abs=1e-6)


@settings(max_examples=1_000)
@given(lengths, bearings, speeds, speeds, blends, mounts, st.floats(0.01, 100.0))
def test_laws_are_homogeneous(
    l: float, psi: float, u_r: float, u_t: float, blend: Blend, mount: Mount, factor: float
) -> None:
    """A command scaled by a positive factor gives all rates scaled by it: scaling keeps a law's shares."""
    for law in (exact(WORKSPACE, blend, mount), paper(WORKSPACE, blend, mount)):
        one, many = law.split(l, psi, u_r, u_t), law.split(l, psi, factor * u_r, factor * u_t)
        for rate in ("v_b", "w_b", "v_m", "w_m"):
            assert getattr(many, rate) == pytest.approx(factor * getattr(one, rate), rel=1e-9, abs=1e-9)


@settings(max_examples=1_000)
@given(lengths, bearings, speeds, speeds, blends)
def test_exact_is_the_same_in_a_mirror(l: float, psi: float, u_r: float, u_t: float, blend: Blend) -> None:
    """Left and right are alike: the mirrored command in the mirrored pose gives the mirrored rates."""
    law = exact(WORKSPACE, blend)
    one, other = law.split(l, psi, u_r, u_t), law.split(l, -psi, u_r, -u_t)
    if abs(u_t + one.v_b * math.sin(psi)) < 1e-9:
        return  # Where the arm has nothing to do sideways, the sign of zero chooses sigma.
    assert (one.v_b, one.v_m) == pytest.approx((other.v_b, other.v_m), abs=TINY)
    assert (one.w_b, one.w_m) == pytest.approx((-other.w_b, -other.w_m), abs=1e-9)


@settings(max_examples=1_000)
@given(lengths, bearings, speeds, speeds, blends)
def test_paper_distorts_by_the_drives_sideways_part(l: float, psi: float, v_c: float, w_c: float, blend: Blend) -> None:
    """With `paper` the EE leaves its command by mu |v_c tan psi|, all of it sideways."""
    split = paper(WORKSPACE, blend).split(l, psi, v_c, l * w_c)
    got = rigid_body_velocity(l, psi, MOUNT_FREE, (split.v_b, split.w_b, split.v_m, split.w_m))
    want = in_base_frame(v_c, l * w_c, psi)
    assert math.dist(got, want) == pytest.approx(split.mu * abs(v_c * math.tan(psi)), abs=TINY)


@given(lengths, bearings, speeds, speeds)
def test_switch_is_12_and_13(l: float, psi: float, v_c: float, w_c: float) -> None:
    """The hard switch gives all to the arm or all to the base, by (12a,b) and (13a,b)."""
    split = switch(WORKSPACE).split(l, psi, v_c, l * w_c)
    base_drives = l > WORKSPACE.l_max if v_c >= 0.0 else l < WORKSPACE.l_min
    base_turns = psi > WORKSPACE.psi_max if w_c >= 0.0 else psi < WORKSPACE.psi_min
    assert split.v_b * math.cos(psi) == pytest.approx(v_c if base_drives else 0.0, abs=TINY)
    assert split.v_m == pytest.approx(0.0 if base_drives else v_c, abs=TINY)
    assert split.w_b == pytest.approx(w_c if base_turns else 0.0, abs=TINY)
    assert split.w_m == pytest.approx(0.0 if base_turns else w_c, abs=TINY)


@given(lengths, bearings, speeds, speeds)
def test_narrow_tanh_is_the_switch(l: float, psi: float, v_c: float, w_c: float) -> None:
    """With alpha and beta without bound, `paper` is `switch` everywhere but at the limits."""
    edges = (l - WORKSPACE.l_min, l - WORKSPACE.l_max, psi - WORKSPACE.psi_min, psi - WORKSPACE.psi_max)
    if min(map(abs, edges)) < 1e-4:
        return
    narrow = paper(WORKSPACE, Tanh(1e6, 1e6)).split(l, psi, v_c, l * w_c)
    hard = switch(WORKSPACE).split(l, psi, v_c, l * w_c)
    assert (narrow.v_b, narrow.w_b, narrow.v_m, narrow.w_m) == pytest.approx(
        (hard.v_b, hard.w_b, hard.v_m, hard.w_m), abs=TINY
    )


@pytest.mark.parametrize("law", [exact(blend=Tanh()), paper(), switch()], ids=lambda law: law.name)
@given(
    st.floats(1e-6, 10.0),
    st.floats(-4.0, 4.0),
    st.floats(-1e6, 1e6),
    st.floats(-1e6, 1e6),
)
def test_rates_are_finite_and_bounded_everywhere(law: Bound, l: float, psi: float, u_r: float, u_t: float) -> None:
    """Beside the base, behind it, anywhere: rates stay finite, the base's speed bounded, scale in [0, 1]."""
    split = law.split(l, psi, u_r, u_t)
    rates = (split.v_b, split.w_b, split.v_m, split.w_m)
    assert all(math.isfinite(rate) for rate in rates)
    assert abs(split.v_b) <= authority.BASE_GAIN * math.hypot(u_r, u_t) * (1.0 + 1e-9)
    assert 0.0 <= split.scale <= 1.0


@given(lengths, st.floats(0.0, 1e-3), st.sampled_from([-1.0, 1.0]), st.floats(0.05, 0.4))
def test_beside_the_base_the_whole_command_is_scaled(l: float, off: float, side: float, v_c: float) -> None:
    """As the hand comes beside the base, drive and scale go to 0 together: nothing races, EE keeps its way."""
    law = exact(WORKSPACE, Step())
    psi = side * (math.pi / 2 - off)
    split = law.split(WORKSPACE.l_max + 0.05, psi, v_c, 0.0)
    assert split.scale <= (authority.BASE_GAIN * math.sin(1e-3)) ** 2 + TINY
    assert abs(split.v_b) <= authority.BASE_GAIN**2 * v_c * math.sin(1e-3) + TINY
    got = rigid_body_velocity(WORKSPACE.l_max + 0.05, psi, MOUNT_FREE, (split.v_b, split.w_b, split.v_m, split.w_m))
    assert math.dist(got, in_base_frame(v_c * split.scale, 0.0, psi)) <= TINY
    assert l > 0.0


@given(lengths, bearings, speeds, speeds, speeds, speeds, mounts)
def test_arm_closes_the_residual_of_any_base_motion(
    l: float, psi: float, u_r: float, u_t: float, v_b: float, w_b: float, mount: Mount
) -> None:
    """Whatever the base really does, the arm's residual makes the EE move as commanded."""
    three = (mount.s_x, mount.s_y, mount.yaw)
    v_m, w_m = authority.arm_residual(l, psi, u_r, u_t, v_b, w_b, three)
    got = rigid_body_velocity(l, psi, mount, (v_b, w_b, v_m, w_m))
    assert math.dist(got, in_base_frame(u_r, u_t, psi + mount.yaw)) <= TINY
    polar = authority.ee_velocity(l, psi, v_b, w_b, v_m, w_m, three)
    assert polar == pytest.approx((u_r, u_t), abs=TINY)


@given(bearings, st.sampled_from([-1.0, 1.0]), mounts)
def test_inside_the_workspace_the_base_stands_still(psi: float, g: float, mount: Mount) -> None:
    """With a blend of compact support the base does not move at all while the hand is well inside."""
    split = exact(WORKSPACE, Smoothstep(0.1, 0.1), mount).split(0.65, psi * 0.7, g * 0.4, -g * 0.2)
    assert (split.mu, split.sigma, split.v_b, split.w_b) == (0.0, 0.0, 0.0, 0.0)


def test_limits_helper_matches_the_law() -> None:
    """The six numbers that the tests hand to the law's functions are those that a law makes of its workspace."""
    blend = Tanh(40.0, 30.0)
    direct = authority.exact(0.8, 0.2, 0.3, 0.1, blend.rise, limits_of(WORKSPACE, blend), (0.0, 0.0, 0.0))
    split = exact(WORKSPACE, blend).split(0.8, 0.2, 0.3, 0.1)
    assert direct == (split.mu, split.sigma, split.v_b, split.w_b, split.v_m, split.w_m, split.scale)
