from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from overreach.arm.chain import NO_REST
from overreach.arm.limits import fastest_towards
from overreach.arm.mount import Mount
from overreach.arm.planar import SINE_DAMPED, Arm2R, forward, inverse, jacobian, polar_rates
from overreach.arm.polar import hand_in_world, wrap
from overreach.verdicts import Verdict
from tests.strategies import angles

links = st.floats(0.1, 1.5)
elbows = st.sampled_from([-1, 1])
rates = st.floats(-0.5, 0.5)


def arm(a: float, b: float, elbow: int = 1) -> Arm2R:
    return Arm2R((a, b), (-4.8, -math.pi), (4.8, math.pi), (3.0, 3.0), (20.0, 20.0), elbow)


def polar_to_joint_rates(
    theta_2: float, v_m: float, w_m: float, a: float, b: float, elbow: int
) -> tuple[float, float, bool]:
    """Return the joint rates of this moment, and whether they are damped."""
    (one, two), verdict = arm(a, b, elbow).at((0.0, theta_2), Mount()).rates(v_m, w_m, NO_REST, 0.0)
    return one, two, verdict is not Verdict.MOVING


@given(angles, angles, links, links)
def test_forward_is_the_chain_of_links(theta_1: float, theta_2: float, a: float, b: float) -> None:
    """(l, psi) is the end of two links laid one after the other."""
    l, psi = forward(theta_1, theta_2, a, b)
    x = a * math.cos(theta_1) + b * math.cos(theta_1 + theta_2)
    y = a * math.sin(theta_1) + b * math.sin(theta_1 + theta_2)
    assert (l * math.cos(psi), l * math.sin(psi)) == pytest.approx((x, y), abs=1e-12)


@given(st.floats(0.001, 0.999), angles, links, links, elbows)
def test_both_inverse_solutions_reach(part: float, psi: float, a: float, b: float, elbow: int) -> None:
    """Either elbow brings the hand to the same place, with theta_2 of the elbow's sign."""
    l = abs(a - b) + part * (a + b - abs(a - b))
    theta_1, theta_2 = inverse(l, psi, a, b, elbow)
    assert forward(theta_1, theta_2, a, b) == pytest.approx((l, psi), abs=1e-7)
    assert theta_2 * elbow >= 0.0


@given(st.floats(-10.0, 10.0), angles, links, links, elbows)
def test_inverse_beyond_the_reach_is_the_nearest(l: float, psi: float, a: float, b: float, elbow: int) -> None:
    """A length that the arm does not have gives the nearest that it has, never nan."""
    theta_1, theta_2 = inverse(l, psi, a, b, elbow)
    assert math.isfinite(theta_1)
    assert math.isfinite(theta_2)
    if abs(l) > a + b:
        assert forward(theta_1, theta_2, a, b)[0] == pytest.approx(a + b, abs=1e-6)


@given(angles, st.floats(0.05, 3.0), links, links, elbows)
def test_jacobian_is_the_slope(theta_1: float, bend: float, a: float, b: float, elbow: int) -> None:
    """The polar Jacobian equals central differences of `forward`."""
    theta_2 = elbow * bend
    if forward(theta_1, theta_2, a, b)[0] < 0.05:
        return
    h = 1e-6
    plus, minus = forward(theta_1, theta_2 + h, a, b), forward(theta_1, theta_2 - h, a, b)
    slopes = ((plus[0] - minus[0]) / (2 * h), wrap(plus[1] - minus[1]) / (2 * h))
    assert jacobian(theta_2, a, b) == pytest.approx(slopes, rel=1e-5, abs=1e-5)


@given(st.floats(0.16, math.pi - 0.16), rates, rates, links, links, elbows)
def test_inverse_jacobian_undoes_the_jacobian(
    bend: float, v_m: float, w_m: float, a: float, b: float, elbow: int
) -> None:
    """Away from the singularities the joint rates give exactly the polar rates that were asked for."""
    theta_2 = elbow * bend
    one, two, damped = polar_to_joint_rates(theta_2, v_m, w_m, a, b, elbow)
    assert not damped
    l = forward(0.0, theta_2, a, b)[0]
    assert polar_rates(theta_2, one, two, a, b) == pytest.approx((v_m, w_m), abs=1e-9 / min(1.0, l**2))


@settings(max_examples=1_000)
@given(
    st.one_of(
        st.floats(-SINE_DAMPED, SINE_DAMPED),
        st.floats(math.pi - SINE_DAMPED, math.pi),
        st.sampled_from([0.0, math.pi, -math.pi]),
    ),
    rates,
    rates,
    elbows,
)
def test_singularities_give_way(theta_2: float, v_m: float, w_m: float, elbow: int) -> None:
    """At |theta_2| = 0 and pi joint rates are finite and bounded, whatever is asked for, and are told of."""
    one, two, damped = polar_to_joint_rates(theta_2, v_m, w_m, 0.5, 0.5, elbow)
    bound = 0.5 / (0.25 * SINE_DAMPED) * 1.01
    assert abs(two) <= bound
    assert abs(one) <= 0.5 + bound
    assert damped == (v_m != 0.0 and abs(math.sin(theta_2)) < SINE_DAMPED)


@pytest.mark.parametrize(("theta_2", "back"), [(0.0, -0.2), (math.pi, 0.2), (1e-9, -0.2)])
def test_backing_out_of_a_singularity_is_possible(theta_2: float, back: float) -> None:
    """From the straight and from the folded arm the hand can come back: the joint moves at a fair speed."""
    _, two, _ = polar_to_joint_rates(theta_2, back, 0.0, 0.5, 0.4, 1)
    assert abs(two) > 0.1
    for _ in range(400):
        _, two, _ = polar_to_joint_rates(theta_2, back, 0.0, 0.5, 0.4, 1)
        theta_2 += two * 0.005
    assert abs(math.sin(theta_2)) > SINE_DAMPED


def test_stretching_never_flips_the_elbow() -> None:
    """Pushed outward for a minute, the arm comes to rest just short of straight, on its own side."""
    theta_2 = 1.0
    for _ in range(12_000):
        _, two, _ = polar_to_joint_rates(theta_2, 0.4, 0.0, 0.5, 0.5, 1)
        theta_2 += two * 0.005
        assert 0.0 < theta_2 < 1.1
    assert theta_2 < 0.01


@given(st.floats(0.3, 0.9), angles, rates, rates, elbows)
def test_whole_steps_end_where_they_should(l: float, psi: float, v_m: float, w_m: float, elbow: int) -> None:
    """Joint rates for a whole step bring the hand to exactly (l + v_m dt, psi + w_m dt)."""
    dt = 0.01
    theta_1, theta_2 = inverse(l, psi, 0.5, 0.5, elbow)
    (one, two), verdict = arm(0.5, 0.5, elbow).at((theta_1, theta_2), Mount()).rates(v_m, w_m, NO_REST, dt)
    got = forward(theta_1 + one * dt, theta_2 + two * dt, 0.5, 0.5)
    assert got == pytest.approx((l + v_m * dt, psi + w_m * dt), abs=1e-9)
    assert verdict is Verdict.MOVING


@given(st.floats(3.3, 6.0), st.sampled_from([-1.0, 1.0]), rates, rates)
def test_whole_steps_of_an_elbow_past_half_a_turn(bend: float, side: float, v_m: float, w_m: float) -> None:
    """Where joints may turn further than half a turn, a whole step goes on from where they are, and jumps nowhere."""
    theta, dt = (0.5, side * bend), 0.005
    chain = arm(0.5, 0.5).at(theta, Mount())
    if abs(math.sin(bend)) < 0.2 or not 0.1 < chain.l < 0.95:
        return
    assert chain.rates(0.0, 0.0, NO_REST, dt)[0] == pytest.approx((0.0, 0.0), abs=1e-9)
    whole, moment = chain.rates(v_m, w_m, NO_REST, dt)[0], chain.rates(v_m, w_m, NO_REST, 0.0)[0]
    assert whole == pytest.approx(moment, abs=0.5)
    after = arm(0.5, 0.5).at((theta[0] + whole[0] * dt, theta[1] + whole[1] * dt), Mount())
    assert (after.l, wrap(after.psi - chain.psi)) == pytest.approx((chain.l + v_m * dt, w_m * dt), abs=1e-9)


def test_whole_steps_end_at_the_reach() -> None:
    """A whole step beyond the arm's end goes to its end and says so."""
    theta = inverse(0.99, 0.2, 0.5, 0.5, 1)
    (one, two), verdict = arm(0.5, 0.5).at(theta, Mount()).rates(0.4, 0.0, NO_REST, 0.1)
    assert forward(theta[0] + one * 0.1, theta[1] + two * 0.1, 0.5, 0.5)[0] == pytest.approx(1.0, abs=1e-9)
    assert verdict is Verdict.OUT_OF_REACH


@given(st.floats(-100.0, 100.0))
def test_wrap_keeps_the_direction(angle: float) -> None:
    """A wrapped angle is in (-pi, pi] and points the same way."""
    wrapped = wrap(angle)
    assert -math.pi < wrapped <= math.pi
    assert math.cos(wrapped - angle) == pytest.approx(1.0, abs=1e-12)


@given(angles, st.floats(0.1, 1.0), angles, st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
def test_hand_in_world_is_a_rotation(theta_b: float, l: float, psi_d: float, s_x: float, s_y: float) -> None:
    """The hand's place in the world is the base's pose applied to its place in the base frame."""
    x, y = hand_in_world(1.0, -2.0, theta_b, l, psi_d, s_x, s_y)
    turn = complex(math.cos(theta_b), math.sin(theta_b))
    place = complex(1.0, -2.0) + turn * (complex(s_x, s_y) + l * complex(math.cos(psi_d), math.sin(psi_d)))
    assert complex(x, y) == pytest.approx(place, abs=1e-12)


@given(st.floats(-1.0, 1.0), st.floats(-3.0, 3.0))
def test_joints_can_always_brake_before_their_limit(theta: float, dtheta: float) -> None:
    """Driven at the allowed speed towards its limit for as long as one likes, a joint never passes it."""
    dt = 0.005
    direction = math.copysign(1.0, dtheta)
    was = None
    for _ in range(600):
        speed = fastest_towards(theta, direction, -1.0, 1.0, 3.0, 20.0, dt)
        theta += direction * speed * dt
        assert -1.0 - 1e-12 <= theta <= 1.0 + 1e-12
        if was is not None:
            # d/dt at the very end of the way takes it a little beyond the braking asked for.
            assert speed - was >= -2.5 * 20.0 * dt
        was = speed
    assert fastest_towards(theta, -direction, -1.0, 1.0, 3.0, 20.0, dt) > 0.5
