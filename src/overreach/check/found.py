"""What was found of a robot, and what looks wrong with it."""

from __future__ import annotations

import math

import mujoco
import numpy as np

from overreach.arm.spatial.screws import Array
from overreach.model.catalogue import load_one, parts_for
from overreach.model.measure.rank import sentence
from overreach.model.mujoco.chain import base_frame
from overreach.model.mujoco.robot import Parts

SMALL, LARGE = 0.05, 5.0
"""A reach [m] outside these is more likely in other units."""
TINY = 1e-5
"""A body whose greatest moment of inertia [kg m^2] is below this, and that is not light, is not real."""
LIGHT = 0.05
FLOOR = 0.01
"""A wheel's lowest point is so near [m] the ground."""
SLOW, FAST = 0.05, 10.0
"""Joint speeds [rad/s] outside these are more likely wrong."""


def facts(which: str) -> list[str]:
    """Return lines on what was found of a robot, and what looks wrong. Raises SetupError."""
    model, parts = load_one(which), parts_for(which)
    arm, space = model.arm, model.workspace
    up = float((arm.R_home @ np.array(arm.manner.approach))[2])
    joints = ", ".join(channel.moves for channel in arm.channels)
    lines = [
        f"{model.name}: {model.summary}",
        f"  base {parts.description.base.kind}, {parts.base.v_max:g} m/s, {parts.base.w_max:g} rad/s",
        f"  arm of {len(arm.channels)} joints: {joints}",
        f"  shoulder at ({model.mount.s_x:.3f}, {model.mount.s_y:.3f}) m, yaw {model.mount.yaw:g} rad; "
        f"reach {arm.manner.reach:.3f} m",
        f"  hand {parts.description.hand.body}: {sentence(arm.manner.held, up)}",
        f"  workspace ({model.mode}): l = {space.l_min:g} to {space.l_max:g} m, psi = {space.psi_min:g} to "
        f"{space.psi_max:g} rad, z = {space.z_min:g} to {space.z_max:g} m",
    ]
    wrong = looks_wrong(parts)
    lines += [f"  looks wrong: {line}" for line in wrong] or ["  nothing looks wrong"]
    return lines


def looks_wrong(parts: Parts) -> list[str]:
    """Return what looks wrong with a robot, a line each."""
    arm, model = parts.arm, parts.model
    found = []
    if not SMALL < arm.manner.reach < LARGE:
        found.append(f"the arm reaches {arm.manner.reach:.3g} m: are its lengths in other units?")
    for channel in arm.channels:
        if channel.upper - channel.lower >= 100.0:
            found.append(f"joint {channel.moves} has no limits")
        if channel.unit == "rad" and not SLOW <= channel.rate_max <= FAST:
            found.append(f"joint {channel.moves} moves at {channel.rate_max:g} rad/s: in degrees, or not set?")
    for body in range(1, model.nbody):
        if model.body_mass[body] > LIGHT and float(model.body_inertia[body].max()) < TINY:
            found.append(f"body {model.body(body).name} has an inertia of {model.body_inertia[body].max():.2g} kg m^2")
    found += [
        f"wheel {name} is {gap * 1e3:.0f} mm off the ground" for name, gap in wheel_gaps(parts) if abs(gap) > FLOOR
    ]
    return found


def wheel_gaps(parts: Parts) -> list[tuple[str, float]]:
    """Return how far above the ground of the base's frame each wheel's lowest point is [m]."""
    model = parts.model
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos0
    mujoco.mj_kinematics(model, data)
    R, p = base_frame(model, data, parts.description)
    gaps = []
    for name in parts.description.base.wheels:
        body = int(model.jnt_bodyid[model.joint(name).id])
        lowest = min(
            (_lowest(model, data, geom, R, p) for geom in range(model.ngeom) if model.geom_bodyid[geom] == body),
            default=math.nan,
        )
        if math.isfinite(lowest):
            gaps.append((name, lowest))
    return gaps


def _lowest(model: mujoco.MjModel, data: mujoco.MjData, geom: int, R: Array, p: Array) -> float:
    at = R.T @ (data.geom_xpos[geom] - p)
    turn = R.T @ data.geom_xmat[geom].reshape(3, 3)
    half = model.geom_aabb[geom, 3:]
    centre = at + turn @ model.geom_aabb[geom, :3]
    size = model.geom_size[geom]
    if int(model.geom_type[geom]) == int(mujoco.mjtGeom.mjGEOM_CYLINDER):
        up = abs(float(turn[2, 2]))
        return float(centre[2] - size[0] * math.sqrt(max(0.0, 1.0 - up * up)) - size[1] * up)
    return float(centre[2] - np.abs(turn[2]) @ half)
