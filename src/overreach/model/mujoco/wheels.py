"""Where a base's wheels stand, by its model: for whoever draws it."""

from __future__ import annotations

import math

import mujoco
import numpy as np

from overreach.model.base import Wheel
from overreach.model.description import Description
from overreach.model.mujoco.chain import base_frame, joint_of


def wheels_of(model: mujoco.MjModel, description: Description) -> tuple[Wheel, ...]:
    """Return the wheels that a description names, in the base frame; raises SetupError for one that is not there."""
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos0
    mujoco.mj_kinematics(model, data)
    R, p = base_frame(model, data, description)
    found = []
    for name in description.base.wheels:
        joint = joint_of(model, name)
        x, y, _ = (R.T @ (data.xanchor[joint] - p)).tolist()
        a_x, a_y, _ = (R.T @ data.xaxis[joint]).tolist()
        geoms = np.flatnonzero(model.geom_bodyid == model.jnt_bodyid[joint])
        radius = float(model.geom_aabb[geoms, 3:].max()) if len(geoms) else RADIUS
        found.append(Wheel(x, y, math.atan2(-a_x, a_y), radius))  # it rolls across its axle
    return tuple(found)


RADIUS = 0.1
"""Radius [m] of a wheel without a shape."""
