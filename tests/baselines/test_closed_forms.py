from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.arm.mount import Mount
from overreach.arm.planar import inverse, polar_rates
from overreach.errors import SetupError
from overreach.law.authority import ee_velocity
from tests.laws import separate, switch, weighted
from tests.strategies import WORKSPACE, bearings, mounts, speeds


def true_jacobian(l: float, psi: float, mount: Mount) -> np.ndarray:
    """Return dEE/d(v_b, w_b, dtheta_1, dtheta_2), polar components, column by column from the true kinematics."""
    three = (mount.s_x, mount.s_y, mount.yaw)
    theta = inverse(l, psi, 0.5, 0.5, 1)
    columns = [ee_velocity(l, psi, 1.0, 0.0, 0.0, 0.0, three), ee_velocity(l, psi, 0.0, 1.0, 0.0, 0.0, three)]
    for rates in ((1.0, 0.0), (0.0, 1.0)):
        v_m, w_m = polar_rates(theta[1], *rates, 0.5, 0.5)
        columns.append(ee_velocity(l, psi, 0.0, 0.0, v_m, w_m, three))
    return np.array(columns).T


@given(st.floats(0.3, 0.9), bearings, speeds, speeds, mounts, st.floats(0.1, 100.0))
def test_weighted_is_the_weighted_pseudo_inverse(
    l: float, psi: float, u_r: float, u_t: float, mount: Mount, base_weight: float
) -> None:
    """Away from singularities the rates are W^-1/2 (J W^-1/2)^+ u, by numpy's own pseudo-inverse."""
    J = true_jacobian(l, psi, mount)
    half = np.diag([base_weight**-0.5, base_weight**-0.5, 1.0, 1.0])
    M = J @ half @ half @ J.T
    if np.linalg.det(M) < 0.011 * np.trace(M) ** 2:
        return
    q = half @ np.linalg.pinv(J @ half) @ [u_r, u_t]
    split = weighted(WORKSPACE, mount, base_weight=base_weight).split(l, psi, u_r, u_t)
    assert (split.v_b, split.w_b) == pytest.approx(q[:2], abs=1e-9)
    three = (mount.s_x, mount.s_y, mount.yaw)
    assert ee_velocity(l, psi, split.v_b, split.w_b, split.v_m, split.w_m, three) == pytest.approx((u_r, u_t), abs=1e-9)


def test_weighted_moves_less_base_the_dearer_it_is() -> None:
    """The base's part falls as its weight grows, and never to zero: it drives for a reach inside the workspace."""
    parts = [weighted(base_weight=w).split(0.6, 0.2, 0.2, 0.0).v_b for w in (1.0, 10.0, 100.0, 1000.0)]
    assert parts == sorted(parts, reverse=True)
    assert parts[-1] > 0.0


@pytest.mark.parametrize("bad", [0.0, -1.0, math.inf])
def test_weights_must_weigh(bad: float) -> None:
    """A base weight that is not a finite number > 0 is refused."""
    with pytest.raises(SetupError, match="base_weight"):
        weighted(base_weight=bad)


@given(st.floats(0.46, 0.84), st.floats(-0.59, 0.59), speeds, speeds)
def test_separate_is_the_arm_alone_inside(l: float, psi: float, u_r: float, u_t: float) -> None:
    """Inside the workspace the stick drives the arm alone, exactly."""
    split = separate(WORKSPACE).split(l, psi, u_r, u_t)
    assert (split.v_b, split.w_b, split.mu, split.sigma) == (0.0, 0.0, 0.0, 0.0)
    assert ee_velocity(l, psi, 0.0, 0.0, split.v_m, split.w_m, (0.0, 0.0, 0.0)) == pytest.approx((u_r, u_t), abs=1e-12)


@given(st.floats(0.86, 0.95), bearings, st.floats(0.01, 0.4), speeds)
def test_separate_gives_the_whole_stick_to_the_base_beyond(l: float, psi: float, v_c: float, w_c: float) -> None:
    """Pushed out of the workspace, forward and turn both go to the base, unlike `switch`, which gives each its own."""
    split = separate(WORKSPACE).split(l, psi, v_c, l * w_c)
    assert (split.v_b, split.w_b, split.v_m, split.w_m) == pytest.approx((v_c, w_c, 0.0, 0.0), abs=1e-12)
    assert switch(WORKSPACE).split(l, min(0.5, abs(psi)), v_c, l * w_c).w_b == 0.0
