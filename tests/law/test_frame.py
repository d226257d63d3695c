from __future__ import annotations

import math

import pytest
from hypothesis import given

from overreach.law.frame import FRAMES, heading_rate
from overreach.types import Frame
from tests.strategies import angles, lengths, speeds


@given(lengths, angles, angles, angles, speeds, speeds)
def test_frames_mean_the_same_velocity(
    l: float, psi_d: float, theta_b: float, theta_e: float, v_c: float, w_c: float
) -> None:
    """Each frame's polar components are the commanded world velocity, seen from the shoulder."""
    bearing = theta_b + psi_d
    r = (math.cos(bearing), math.sin(bearing))
    t = (-r[1], r[0])
    want = {
        Frame.HAND: (
            v_c * math.cos(theta_e) + w_c * l * t[0],
            v_c * math.sin(theta_e) + w_c * l * t[1],
        ),
        Frame.POLAR: (v_c * r[0] + w_c * l * t[0], v_c * r[1] + w_c * l * t[1]),
        Frame.BASE: (
            v_c * math.cos(theta_b) - w_c * math.sin(theta_b),
            v_c * math.sin(theta_b) + w_c * math.cos(theta_b),
        ),
        Frame.WORLD: (v_c, w_c),
    }
    for frame, to_polar in FRAMES.items():
        u_r, u_t = to_polar(v_c, w_c, l, psi_d, theta_b, theta_e)
        got = (u_r * r[0] + u_t * t[0], u_r * r[1] + u_t * t[1])
        assert got == pytest.approx(want[frame], abs=1e-12)


def test_only_the_frame_hand_has_a_heading_of_its_own() -> None:
    """The hand turns at w_c in its own frame; in the others its heading is its bearing."""
    assert heading_rate(Frame.HAND, 0.3) == 0.3
    assert all(heading_rate(frame, 0.3) is None for frame in Frame if frame is not Frame.HAND)
