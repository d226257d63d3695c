"""The lean steps that are timed are the laws that are compared."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.arm.chain import NO_REST
from overreach.arm.mount import Mount
from overreach.arm.planar import forward
from overreach.baselines.qp import PaperQP, Program
from overreach.bench.planar_paper import paper_step
from overreach.bench.planar_qp import PlanarQP
from overreach.law.blend import Blend
from overreach.model.planar import load_planar, planar
from overreach.types import HandTwist
from tests.laws import paper
from tests.strategies import WORKSPACE, angles, blends, limits_of, mounts, speeds

LINKS = (0.5, 0.4)
ARM = load_planar("[arm]\nlinks = [0.5, 0.4]").arm


@given(angles, st.floats(0.01, 3.0), speeds, speeds, blends, mounts)
def test_the_papers_full_step_is_its_parts(
    theta_1: float, theta_2: float, v_c: float, w_c: float, blend: Blend, mount: Mount
) -> None:
    """Forward kinematics, frame, the paper's law and joint rates in one function are what they are one by one."""
    l, psi = forward(theta_1, theta_2, *LINKS)
    split = paper(WORKSPACE, blend, mount).split(l, psi, v_c, w_c * l)
    want = (split.v_b, split.w_b, *ARM.at((theta_1, theta_2), mount).rates(split.v_m, split.w_m, NO_REST, 0.0)[0])
    got = paper_step(theta_1, theta_2, v_c, w_c, blend.rise, limits_of(WORKSPACE, blend), mount.three, *LINKS)
    assert got == pytest.approx(want, rel=1e-7, abs=1e-9)


@given(angles, st.floats(0.01, 3.0), speeds, speeds)
def test_the_lean_program_is_the_papers(theta_1: float, theta_2: float, v_c: float, w_c: float) -> None:
    """The quadratic program written out for two links is that of the Jacobian, for any arm."""
    model = planar()
    lean, program = PlanarQP(model, "daqp"), Program(PaperQP(), model)
    P, q = lean.model(theta_1, theta_2, v_c, w_c)
    want_P, want_q = program.problem(model.arm.at((theta_1, theta_2), model.mount), v_c, w_c, HandTwist())
    assert np.allclose(P, want_P, atol=1e-12)
    assert np.allclose(q, want_q, atol=1e-12)
    assert np.array_equal(lean.q_max, program.q_max)
