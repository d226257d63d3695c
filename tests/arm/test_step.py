from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.arm.planar import forward, polar_to_joint_rates
from overreach.arm.step import planar_step, polar_step
from overreach.law.blend import Blend
from overreach.law.frame import hand, polar
from overreach.law.laws import Law, exact, paper
from overreach.law.workspace import Mount
from tests.strategies import WORKSPACE, angles, blends, limits_of, mounts, speeds

LINKS = (0.5, 0.4)


def composed(
    law: Law, theta_1: float, theta_2: float, frame: object, command: tuple[float, float], *headings: float
) -> tuple[float, ...]:
    """Return the rates by the parts that the step is made of, one after the other."""
    l, psi = forward(theta_1, theta_2, *LINKS)
    u = frame(*command, l, psi + law.mount.yaw, *headings)  # type: ignore[operator]  # one of law.frame's
    split = law.split(l, psi, *u)
    dtheta = polar_to_joint_rates(theta_2, split.v_m, split.w_m, *LINKS, 1)
    return split.v_b, split.w_b, dtheta[0], dtheta[1]


@given(angles, st.floats(0.01, 3.0), angles, angles, speeds, speeds, blends, mounts)
def test_the_full_step_is_its_parts(
    theta_1: float, theta_2: float, theta_b: float, theta_e: float, v_c: float, w_c: float, blend: Blend, mount: Mount
) -> None:
    """Forward kinematics, frame, law and joint rates in one function give what they give one after the other."""
    three = (mount.s_x, mount.s_y, mount.yaw)
    law = exact(WORKSPACE, blend, mount)
    want = composed(law, theta_1, theta_2, hand, (v_c, w_c), theta_b, theta_e)
    got = planar_step(
        theta_1, theta_2, theta_b, theta_e, v_c, w_c, blend.rise, limits_of(WORKSPACE, blend), three, *LINKS
    )
    assert got == pytest.approx(want, rel=1e-7, abs=1e-9)


@given(angles, st.floats(0.01, 3.0), speeds, speeds, blends, mounts)
def test_the_papers_full_step_is_its_parts(
    theta_1: float, theta_2: float, v_c: float, w_c: float, blend: Blend, mount: Mount
) -> None:
    """The same for the paper's law and its frame."""
    three = (mount.s_x, mount.s_y, mount.yaw)
    law = paper(WORKSPACE, blend, mount)
    want = composed(law, theta_1, theta_2, polar, (v_c, w_c), 0.0, 0.0)
    got = polar_step(theta_1, theta_2, v_c, w_c, blend.rise, limits_of(WORKSPACE, blend), three, *LINKS)
    assert got == pytest.approx(want, rel=1e-7, abs=1e-9)
