"""mobile4: a small robot: two driven wheels and a ball caster, an arm of four joints that reaches 0.35 m, a gripper."""

from __future__ import annotations

import mujoco

from overreach.model.mujoco.primitives import (
    BODY,
    DARK,
    HAND,
    LIMB,
    Geom,
    box,
    cylinder,
    fingers,
    hinge,
    limb,
    velocity_motor,
    wheel,
)  # fmt: skip

Y, Z = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
RADIUS, TRACK = 0.033, 0.26
UPPER, FORE, HAND_AT = 0.13, 0.12, 0.06
"""Lengths [m] of the upper arm, of the forearm, and from the wrist to the hand's own body."""


def spec() -> mujoco.MjSpec:
    """Return the model, to be compiled."""
    made = mujoco.MjSpec()
    made.modelname = "mobile4"
    made.compiler.degree = False
    base = made.worldbody.add_body(name="base")
    base.add_freejoint(name="free")
    box(base, (-0.03, 0.0, 0.06), (0.11, 0.115, 0.03), 1.3)
    box(base, (-0.03, 0.0, 0.095), (0.1, 0.1, 0.005), 0.3, DARK)
    wheel(base, "left", (0.0, 0.5 * TRACK, RADIUS), RADIUS, 0.018, 0.06)
    wheel(base, "right", (0.0, -0.5 * TRACK, RADIUS), RADIUS, 0.018, 0.06)
    base.add_geom(type=Geom.mjGEOM_SPHERE, pos=(-0.11, 0.0, 0.012), size=(0.012, 0.0, 0.0), mass=0.02, rgba=DARK)

    shoulder = base.add_body(name="shoulder", pos=(0.03, 0.0, 0.1))
    hinge(shoulder, "arm_1", Z, -2.6, 2.6, 0.05)
    cylinder(shoulder, (0.0, 0.0, 0.02), 0.022, 0.02, 0.12, LIMB)
    upper = shoulder.add_body(name="upper_arm", pos=(0.0, 0.0, 0.05))
    hinge(upper, "arm_2", Y, -1.9, 1.6, 0.05)
    limb(upper, (0.0, 0.0, 0.0), (UPPER, 0.0, 0.0), 0.016, 0.14, BODY)
    fore = upper.add_body(name="forearm", pos=(UPPER, 0.0, 0.0))
    hinge(fore, "arm_3", Y, -0.1, 2.6, 0.05)
    limb(fore, (0.0, 0.0, 0.0), (FORE, 0.0, 0.0), 0.015, 0.13, LIMB)
    hand = fore.add_body(name="hand", pos=(FORE, 0.0, 0.0))
    hinge(hand, "arm_4", Y, -1.9, 2.0, 0.03)
    limb(hand, (0.0, 0.0, 0.0), (HAND_AT - 0.02, 0.0, 0.0), 0.013, 0.08, BODY)
    box(hand, (HAND_AT - 0.01, 0.0, 0.0), (0.008, 0.024, 0.012), 0.04, HAND)
    fingers(hand, HAND_AT, 0.035, 0.018, 0.006)

    for name in ("wheel_left", "wheel_right"):
        velocity_motor(made, name, 2.0, 2.0)
    for name, most in (("1", 1.5), ("2", 2.5), ("3", 1.5), ("4", 1.0)):
        velocity_motor(made, f"arm_{name}", 3.0, most)
    return made
