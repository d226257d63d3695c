from __future__ import annotations

import math

import pytest
from hypothesis import given
from msgspec.structs import astuple

from overreach.law.frame import FRAMES, axes, heading_rate, meant, of_two
from overreach.types import Frame, Twist
from tests.strategies import angles, lengths, speeds


@given(lengths, angles, angles, angles, speeds, speeds, speeds)
def test_frames_mean_the_same_velocity(
    l: float, psi_d: float, theta_b: float, theta_e: float, v_x: float, v_y: float, w_z: float
) -> None:
    """In each frame x and y lie along its axes, and w_z sweeps the hand about the shoulder, seen in the world."""
    bearing = theta_b + psi_d
    r = complex(math.cos(bearing), math.sin(bearing))
    along = {Frame.HAND: theta_e, Frame.POLAR: bearing, Frame.BASE: theta_b, Frame.WORLD: 0.0, Frame.TOOL: bearing}
    for frame, angle in FRAMES.items():
        turn = complex(math.cos(along[frame]), math.sin(along[frame]))
        twist = Twist(v_x, v_y, 0.1, 0.2, -0.3, w_z)
        u = meant(angle, twist, l, psi_d, theta_b, theta_e)
        assert complex(u.u_r, u.u_t) * r == pytest.approx(complex(v_x, v_y) * turn + w_z * l * 1j * r, abs=1e-12)
        assert complex(u.w_r, u.w_t) * r == pytest.approx(complex(0.2, -0.3) * turn, abs=1e-12)
        assert (u.u_z, u.w_z) == (0.1, w_z)


def test_a_stick_of_two_axes() -> None:
    """Forward is v_x; leftward is v_y where the axes lie still in base or world, else a turn about the shoulder."""
    for frame in Frame:
        twist = of_two(frame, 0.1, 0.2)
        assert [getattr(twist, name) for name in axes(frame)] == [0.1, 0.2]
        assert sum(map(abs, astuple(twist))) == pytest.approx(0.3)
    assert axes(Frame.HAND) == axes(Frame.POLAR) == ("v_x", "w_z")
    assert axes(Frame.BASE) == axes(Frame.WORLD) == ("v_x", "v_y")


def test_only_the_frame_hand_has_a_heading_of_its_own() -> None:
    """The hand turns at w_z in its own frame; in the others its heading is its bearing."""
    assert heading_rate(Frame.HAND, 0.3) == 0.3
    assert all(heading_rate(frame, 0.3) is None for frame in Frame if frame is not Frame.HAND)
