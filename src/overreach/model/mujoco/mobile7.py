"""mobile7: two driven wheels, four casters, a lift, an arm of seven joints that reaches 0.8 m, and a gripper."""

from __future__ import annotations

import mujoco

from overreach.model.mujoco.lift_arm7 import add_arm, add_motors
from overreach.model.mujoco.primitives import DARK, box, caster, velocity_motor, wheel

RADIUS, TRACK = 0.1, 0.44


def spec() -> mujoco.MjSpec:
    """Return the model, to be compiled."""
    made = mujoco.MjSpec()
    made.modelname = "mobile7"
    made.compiler.degree = False
    base = made.worldbody.add_body(name="base")
    base.add_freejoint(name="free")
    box(base, (0.0, 0.0, 0.17), (0.25, 0.19, 0.1), 28.0)
    box(base, (0.02, 0.0, 0.28), (0.2, 0.16, 0.015), 2.0, DARK)
    wheel(base, "left", (0.0, 0.5 * TRACK, RADIUS), RADIUS, 0.05, 1.5)
    wheel(base, "right", (0.0, -0.5 * TRACK, RADIUS), RADIUS, 0.05, 1.5)
    for name, x, y in (
        ("front_left", 0.2, 0.13),
        ("front_right", 0.2, -0.13),
        ("rear_left", -0.2, 0.13),
        ("rear_right", -0.2, -0.13),
    ):
        caster(base, f"caster_{name}", (x, y, 0.08), 0.035, 0.02)
    add_arm(base)

    for name in ("wheel_left", "wheel_right"):
        velocity_motor(made, name, 20.0, 40.0)
    add_motors(made)
    return made
