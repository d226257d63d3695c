"""One line of a run in space: where the hand is and what it was commanded, in world axes, beside all that moves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from overreach.arm.chain import Governing, governs
from overreach.control.tick import Tick
from overreach.model.model import Model
from overreach.types import Frame, RobotState


class SpatialRow(NamedTuple):
    """The state at t, and the rates from t on.

    scale: the part of what the gate let through that is carried out; u_x .. u_wz: the hand's commanded twist in world
    axes [m/s, rad/s], after the gate, times the scale: where its yaw follows the bearing, that is commanded too; x_e ..
    qz_e: the hand's pose in the world; q, dq: the arm's joints.
    """

    t: float
    verdict: str
    scale: float
    mu: float
    sigma: float
    l: float
    psi: float
    z: float
    u_x: float
    u_y: float
    u_z: float
    u_wx: float
    u_wy: float
    u_wz: float
    x_e: float
    y_e: float
    z_e: float
    qw_e: float
    qx_e: float
    qy_e: float
    qz_e: float
    x_b: float
    y_b: float
    theta_b: float
    v_b_x: float
    v_b_y: float
    w_b: float
    q: tuple[float, ...]
    dq: tuple[float, ...]


def is_spatial(model: Model) -> bool:
    """Say whether the hand moves in space, and not in the plane alone."""
    return governs(model.arm)


def header(model: Model) -> list[str]:
    """Return the columns' names; joints by their names in the model file."""
    joints = [channel.moves for channel in model.arm.channels]
    return [*SpatialRow._fields[:-2], *[f"q_{name}" for name in joints], *[f"dq_{name}" for name in joints]]


def columns(row: SpatialRow) -> Sequence[float | str]:
    """Return the row as it is written."""
    return (*row[:-2], *row.q, *row.dq)


def spatial_row(tick: Tick, true: RobotState, model: Model) -> SpatialRow:
    """Return the row of a tick, for the robot's true state with the rates from then on."""
    chain: Governing = model.arm.at(true.q, model.mount)  # type: ignore[assignment]  # as `is_spatial` has found
    decided = tick.decided
    x, y, z = chain.hand
    c, s = math.cos(true.theta_b), math.sin(true.theta_b)
    bearing = true.theta_b + chain.psi + model.mount.yaw
    c_r, s_r = math.cos(bearing), math.sin(bearing)
    u, k = decided.u, decided.scale
    turn = np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))
    in_place = tick.gated.frame is Frame.TOOL and getattr(model.arm, "whole", False)
    w_c, turn_z = (0.0, k * u.w_z) if in_place else (k * u.w_z, 0.0)
    w = turn @ chain.turning(w_c, true.w_b, tick.joints, (k * u.w_r, k * u.w_t, turn_z), decided.attitude)
    return SpatialRow(
        t=tick.now, verdict=tick.verdict.value, scale=k, mu=decided.split.mu, sigma=decided.split.sigma,
        l=chain.l, psi=chain.psi, z=z,
        u_x=k * (c_r * u.u_r - s_r * u.u_t), u_y=k * (s_r * u.u_r + c_r * u.u_t), u_z=k * u.u_z,
        u_wx=float(w[0]), u_wy=float(w[1]), u_wz=float(w[2]),
        x_e=true.x_b + c * x - s * y, y_e=true.y_b + s * x + c * y, z_e=z, **_quaternion(turn @ chain.attitude),
        x_b=true.x_b, y_b=true.y_b, theta_b=true.theta_b, v_b_x=true.v_b, v_b_y=true.motion.v_y, w_b=true.w_b,
        q=true.q, dq=true.dq,
    )  # fmt: skip


def _quaternion(R: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> dict[str, float]:
    """Return the unit quaternion of R (3, 3), with qw >= 0."""
    w = math.sqrt(max(0.0, 1.0 + R[0, 0] + R[1, 1] + R[2, 2]))
    x = math.sqrt(max(0.0, 1.0 + R[0, 0] - R[1, 1] - R[2, 2]))
    y = math.sqrt(max(0.0, 1.0 - R[0, 0] + R[1, 1] - R[2, 2]))
    z = math.sqrt(max(0.0, 1.0 - R[0, 0] - R[1, 1] + R[2, 2]))
    # From the greatest of the four, which loses nothing to rounding.
    if w >= max(x, y, z):
        q = (w, (R[2, 1] - R[1, 2]) / w, (R[0, 2] - R[2, 0]) / w, (R[1, 0] - R[0, 1]) / w)
    elif x >= max(y, z):
        q = ((R[2, 1] - R[1, 2]) / x, x, (R[0, 1] + R[1, 0]) / x, (R[0, 2] + R[2, 0]) / x)
    elif y >= z:
        q = ((R[0, 2] - R[2, 0]) / y, (R[0, 1] + R[1, 0]) / y, y, (R[1, 2] + R[2, 1]) / y)
    else:
        q = ((R[1, 0] - R[0, 1]) / z, (R[0, 2] + R[2, 0]) / z, (R[1, 2] + R[2, 1]) / z, z)
    half = 0.5 if q[0] >= 0.0 else -0.5
    return {name: float(half * one) for name, one in zip(("qw_e", "qx_e", "qy_e", "qz_e"), q, strict=True)}
