"""The law for a base that moves sideways too."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from overreach.arm.mount import Mount
from overreach.law import authority
from overreach.law.blend import Blend, Smoothstep, Step, Tanh
from overreach.law.laws import Exact
from overreach.model.model import Model
from overreach.model.planar import planar
from overreach.plugs import load_model
from overreach.testing.law import check_law
from overreach.testing.whole_body import check_whole_body
from tests.strategies import WORKSPACE, bearings, blends, lengths, limits_of, mounts, speeds

turnings = st.floats(-2.0, 2.0)


@settings(max_examples=1_000)
@given(lengths, bearings, speeds, speeds, turnings, blends, mounts)
def test_the_base_carries_its_share_itself(
    l: float, psi: float, u_r: float, u_t: float, w_c: float, blend: Blend, mount: Mount
) -> None:
    """What the base does to the hand is (mu u_r, sigma u_t), its turning sigma w_c; base and arm together are u."""
    limits = limits_of(WORKSPACE, blend)
    mu, sigma, v_x, v_y, w_b, v_m, w_m = authority.omni(l, psi, u_r, u_t, w_c, blend.rise, limits, mount.three)
    size = 1.0 + abs(u_r) + abs(u_t) + abs(w_c)
    carried = authority.ee_velocity(l, psi, v_x, w_b, 0.0, 0.0, mount.three, v_y)
    assert carried == pytest.approx((mu * u_r, sigma * u_t), abs=1e-12 * size)
    assert w_b == sigma * w_c
    assert authority.ee_velocity(l, psi, v_x, w_b, v_m, w_m, mount.three, v_y) == pytest.approx(
        (u_r, u_t), abs=1e-12 * size
    )


@given(bearings, speeds, turnings, mounts)
def test_bands_end_at_their_edges(psi: float, u_t: float, w_c: float, mount: Mount) -> None:
    """At the outer edge of a band of the smoothstep the arm's rate across it is 0: the band is never left."""
    blend = Smoothstep()
    limits = limits_of(WORKSPACE, blend)
    l_min, l_max, psi_min, psi_max, k_l, k_psi = limits
    for l, u_r in ((l_max + 0.5 * k_l, 0.3), (l_min - 0.5 * k_l, -0.3)):
        assert authority.omni(l, psi, u_r, u_t, w_c, blend.rise, limits, mount.three)[5] == 0.0
    for edge, u in ((psi_max + 0.5 * k_psi, abs(u_t)), (psi_min - 0.5 * k_psi, -abs(u_t))):
        assert authority.omni(0.6, edge, 0.1, u, w_c, blend.rise, limits, mount.three)[6] == 0.0


@given(lengths, turnings, mounts)
def test_a_sweep_past_the_bearing_turns_the_base_about_the_shoulder(l: float, w_c: float, mount: Mount) -> None:
    """Where the base has all of the turning, a pure sweep leaves the shoulder where it is in the world."""
    psi = WORKSPACE.psi_max + 0.5 if w_c >= 0.0 else WORKSPACE.psi_min - 0.5
    blend, u_t = Step(), w_c * l
    _, sigma, v_x, v_y, w_b, _, _ = authority.omni(
        l, psi, 0.0, u_t, w_c, blend.rise, limits_of(WORKSPACE, blend), mount.three
    )
    if u_t != 0.0:  # it is, too, of the smallest turning that a float can say
        assert sigma == 1.0
    at = (v_x - w_b * mount.s_y, v_y + w_b * mount.s_x)
    assert math.hypot(*at) <= 1e-12


@pytest.mark.parametrize("robot", ["omni7", "omni5"])
@pytest.mark.parametrize("blend", [Smoothstep(), Tanh()], ids=["smoothstep", "tanh"])
def test_it_conforms(robot: str, blend: Blend) -> None:
    """It keeps all the promises of a law, and of a whole body, on robots whose base moves sideways too."""
    model = load_model(robot)
    check_law(Exact(blend), model)
    check_whole_body(Exact(blend), model, cases=60)


def test_a_base_that_cannot_is_not_moved_sideways() -> None:
    """On a differential base the law says nothing of sideways, and the robot has no such rate."""

    def sideways(model: Model) -> bool:
        share = Exact().bind(model)
        return share(0.9, 0.3, 0.2, 0.1).v_y is not None

    one = planar()
    assert not sideways(one)
    assert len(one.base.channels) == one.base.axes == 2
    omni = replace(one, base=replace(one.base, omni=True))
    assert sideways(omni)
    assert [channel.name for channel in omni.base.channels] == ["v_b_x", "v_b_y", "w_b"]
