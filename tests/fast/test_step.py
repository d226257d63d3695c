from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.arm.chain import NO_REST
from overreach.arm.mount import Mount
from overreach.arm.planar import forward
from overreach.fast.step import planar_step
from overreach.law.blend import Blend
from overreach.law.frame import hand, meant
from overreach.model.planar import load_planar
from tests.laws import exact
from tests.said import push
from tests.strategies import WORKSPACE, angles, blends, limits_of, mounts, speeds

LINKS = (0.5, 0.4)
ARM = load_planar("[arm]\nlinks = [0.5, 0.4]").arm


@given(angles, st.floats(0.01, 3.0), angles, angles, speeds, speeds, blends, mounts)
def test_the_full_step_is_its_parts(
    theta_1: float, theta_2: float, theta_b: float, theta_e: float, v_c: float, w_c: float, blend: Blend, mount: Mount
) -> None:
    """Forward kinematics, frame, law and joint rates in one function give what they give one after the other."""
    three = (mount.s_x, mount.s_y, mount.yaw)
    l, psi = forward(theta_1, theta_2, *LINKS)
    u = meant(hand, push(v_c, w_c), l, psi + mount.yaw, theta_b, theta_e)
    split = exact(WORKSPACE, blend, mount).split(l, psi, u.u_r, u.u_t)
    want = (split.v_b, split.w_b, *ARM.at((theta_1, theta_2), mount).rates(split.v_m, split.w_m, NO_REST, 0.0)[0])
    got = planar_step(
        theta_1, theta_2, theta_b, theta_e, v_c, w_c, blend.rise, limits_of(WORKSPACE, blend), three, *LINKS
    )
    assert got == pytest.approx(want, rel=1e-7, abs=1e-9)
