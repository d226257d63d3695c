"""What the operator's twist means: the command frames, and the conversion of each to polar axes at the hand.

A frame sets the axes along which the twist's x and y lie: its x axis is at an angle from r, the direction outward
from the shoulder. w_z sweeps the hand about the shoulder, in every frame:
    u = R(angle) v + w_z z x (p_e - p_shoulder)
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin

from overreach.types import Frame, HandTwist, Twist

CommandFrame = Callable[[float, float, float], float]
"""(psi_d, theta_b, theta_e): bearing of the hand in the base frame, headings of base and hand [rad] -> angle [rad]."""


def hand(psi_d: float, theta_b: float, theta_e: float) -> float:
    """X goes where the hand points, w_z sweeps it about the shoulder and turns it (dtheta_e = w_z).

    This is the paper's unicycle (2), made true in rigid-body kinematics: straight stays straight.
    """
    return theta_e - theta_b - psi_d


def polar(psi_d: float, theta_b: float, theta_e: float) -> float:
    """X outward along r, w_z about the shoulder: the paper's text, literally."""
    return 0.0


def base(psi_d: float, theta_b: float, theta_e: float) -> float:
    """X along the base's x axis, y along its y axis."""
    return -psi_d


def world(psi_d: float, theta_b: float, theta_e: float) -> float:
    """X along the world's x axis, y along its y axis."""
    return -(psi_d + theta_b)


FRAMES: dict[Frame, CommandFrame] = {
    Frame.HAND: hand,
    Frame.POLAR: polar,
    Frame.BASE: base,
    Frame.WORLD: world,
}


def meant(angle: CommandFrame, twist: Twist, l: float, psi_d: float, theta_b: float, theta_e: float) -> HandTwist:
    """Return, in polar axes, a twist given in the frame of `angle`, for the hand at (l [m], psi_d [rad])."""
    turn = angle(psi_d, theta_b, theta_e)
    c, s = cos(turn), sin(turn)
    v_x, v_y, w_x, w_y = twist.v_x, twist.v_y, twist.w_x, twist.w_y
    u_r, u_t = v_x * c, v_x * s
    if v_y != 0.0:
        u_r -= v_y * s
        u_t += v_y * c
    return HandTwist(u_r, u_t + twist.w_z * l, twist.v_z, w_x * c - w_y * s, w_x * s + w_y * c, twist.w_z)


def heading_rate(frame: Frame, w_z: float) -> float | None:
    """Return dtheta_e [rad/s] where the hand has a heading of its own, else None (it follows r)."""
    return w_z if frame is Frame.HAND else None


def axes(frame: Frame) -> tuple[str, str]:
    """Return the twist components that a two-axis stick, forward and leftward, commands in `frame`."""
    return ("v_x", "w_z") if frame in (Frame.HAND, Frame.POLAR) else ("v_x", "v_y")


def of_two(frame: Frame, forward: float, left: float) -> Twist:
    """Return the twist of a two-axis stick: forward in m/s, left in m/s or rad/s; see `axes`."""
    _, second = axes(frame)
    return Twist(forward, w_z=left) if second == "w_z" else Twist(forward, left)
