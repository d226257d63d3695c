"""omni7: the lift, arm and gripper of mobile7 on four mecanum wheels."""

from __future__ import annotations

import mujoco

from overreach.model.mujoco.lift_arm7 import add_arm, add_motors
from overreach.model.mujoco.primitives import DARK, box, omni_wheel, velocity_motor

RADIUS, WIDTH = 0.1, 0.08
LONG, WIDE = 0.36, 0.42
"""Distances [m] between the axles, and between the wheels of one."""


def spec() -> mujoco.MjSpec:
    """Return the model, to be compiled."""
    made = mujoco.MjSpec()
    made.modelname = "omni7"
    made.compiler.degree = False
    base = made.worldbody.add_body(name="base")
    base.add_freejoint(name="free")
    box(base, (0.0, 0.0, 0.17), (0.29, 0.16, 0.1), 30.0)
    box(base, (0.02, 0.0, 0.28), (0.24, 0.14, 0.015), 2.0, DARK)
    names = []
    for end, x in (("front", 0.5 * LONG), ("rear", -0.5 * LONG)):
        for side, y in (("left", 0.5 * WIDE), ("right", -0.5 * WIDE)):
            names.append(f"{end}_{side}")
            omni_wheel(base, names[-1], (x, y, RADIUS), 0.0, RADIUS, WIDTH)
    add_arm(base)

    for name in names:
        velocity_motor(made, f"wheel_{name}", 20.0, 40.0)
    add_motors(made)
    return made
