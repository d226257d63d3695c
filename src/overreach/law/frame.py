"""What the operator's (v_c, w_c) means: command frames, each a pure function to polar components.

Each takes v_c, w_c, the length l [m], psi_d (the EE's bearing in the base frame [rad]), theta_b and
theta_e (headings of base and hand in the world [rad]) and returns (u_r, u_t) [m/s].
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin

from overreach.types import Frame

CommandFrame = Callable[[float, float, float, float, float, float], tuple[float, float]]


def hand(
    v_c: float,
    w_c: float,
    l: float,
    psi_d: float,
    theta_b: float,
    theta_e: float,
) -> tuple[float, float]:
    """v_c goes where the hand points, w_c sweeps it about the shoulder and turns it (dtheta_e = w_c).

    This is the paper's unicycle (2), made true in rigid-body kinematics: straight stays straight.
    """
    delta = theta_e - theta_b - psi_d
    return v_c * cos(delta), v_c * sin(delta) + w_c * l


def polar(
    v_c: float,
    w_c: float,
    l: float,
    psi_d: float,
    theta_b: float,
    theta_e: float,
) -> tuple[float, float]:
    """v_c outward along r, w_c about the shoulder: the paper's text, literally."""
    return v_c, w_c * l


def base(
    v_c: float,
    w_c: float,
    l: float,
    psi_d: float,
    theta_b: float,
    theta_e: float,
) -> tuple[float, float]:
    """v_c [m/s] along the base's x axis, w_c [m/s] along its y axis."""
    c, s = cos(psi_d), sin(psi_d)
    return v_c * c + w_c * s, w_c * c - v_c * s


def world(
    v_c: float,
    w_c: float,
    l: float,
    psi_d: float,
    theta_b: float,
    theta_e: float,
) -> tuple[float, float]:
    """v_c [m/s] along the world's x axis, w_c [m/s] along its y axis."""
    return base(v_c, w_c, l, psi_d + theta_b, 0.0, 0.0)


FRAMES: dict[Frame, CommandFrame] = {
    Frame.HAND: hand,
    Frame.POLAR: polar,
    Frame.BASE: base,
    Frame.WORLD: world,
}


def heading_rate(frame: Frame, w_c: float) -> float | None:
    """Return dtheta_e [rad/s] where the hand has a heading of its own, else None (it follows r)."""
    return w_c if frame is Frame.HAND else None
