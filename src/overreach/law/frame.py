"""What the operator's twist means: the command frames, and the conversion of each to polar axes at the hand.

A frame sets the axes along which the twist's x and y lie: its x axis is at an angle from r, the direction outward
from the shoulder. w_z sweeps the hand about the shoulder:
    u = R(angle) v + w_z z x (p_e - p_shoulder)
In the frame of the tool all six are along the hand's own axes, and turn it in its place.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import cos, sin

from overreach.arm.chain import Arm, governs, is_aside, turns_by_itself
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


def tool(psi_d: float, theta_b: float, theta_e: float) -> float:
    """X goes where the gripper points, z to its upper side, and it turns in its place: as through a camera in the hand.

    Of a hand in the plane the same as polar.
    """
    return 0.0


FRAMES: dict[Frame, CommandFrame] = {
    Frame.HAND: hand,
    Frame.POLAR: polar,
    Frame.BASE: base,
    Frame.WORLD: world,
    Frame.TOOL: tool,
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


def meant_by_tool(axes: Sequence[Sequence[float]], twist: Twist, l: float, whole: bool) -> HandTwist:
    """Return, in polar axes, a twist along the hand's own axes; these are the columns of `axes` (3, 3).

    whole: whether the arm can turn the hand about any axis. One that cannot turns it about the axis that it points
    along and about t, and sweeps it about the shoulder.
    """
    v_x, v_y, v_z = twist.v_x, twist.v_y, twist.v_z
    w_x, w_y, w_z = twist.w_x, twist.w_y, twist.w_z
    u_r, u_t, u_z = [a * v_x + b * v_y + c * v_z for a, b, c in axes]
    if not whole:
        return HandTwist(u_r, u_t + w_z * l, u_z, w_x, w_y, w_z)
    w_r, w_t, w_z = [a * w_x + b * w_y + c * w_z for a, b, c in axes]
    return HandTwist(u_r, u_t, u_z, w_r, w_t, w_z)


def heading_rate(frame: Frame, w_z: float) -> float | None:
    """Return dtheta_e [rad/s] where the hand has a heading of its own, else None (it follows r)."""
    return w_z if frame is Frame.HAND else None


def axes(frame: Frame) -> tuple[str, str]:
    """Return the twist components that a two-axis stick, forward and leftward, commands in `frame`."""
    return ("v_x", "w_z") if frame in (Frame.HAND, Frame.POLAR) else ("v_x", "v_y")


def frames_of(arm: Arm) -> tuple[Frame, ...]:
    """Return the frames in which the hand of `arm` can be commanded: along its own axes where it has an attitude.

    Where a base has to swing round behind the hand, a way that turns with the base would never be reached: such an arm
    is commanded along ways that stay in the world.
    """
    if is_aside(arm):
        return (Frame.HAND, Frame.WORLD, *((Frame.TOOL,) if turns_by_itself(arm) else ()))
    return tuple(frame for frame in Frame if frame is not Frame.TOOL or governs(arm))


def of_two(frame: Frame, forward: float, left: float) -> Twist:
    """Return the twist of a two-axis stick: forward in m/s, left in m/s or rad/s; see `axes`."""
    _, second = axes(frame)
    return Twist(forward, w_z=left) if second == "w_z" else Twist(forward, left)
