"""omni5: a small robot: three omni wheels, an arm of five joints that reaches 0.4 m, a gripper."""

from __future__ import annotations

import math

import mujoco

from overreach.model.mujoco.primitives import (
    BODY,
    DARK,
    HAND,
    LIMB,
    box,
    cylinder,
    fingers,
    hinge,
    limb,
    omni_wheel,
    velocity_motor,
)  # fmt: skip

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
RADIUS, WIDTH, AT = 0.05, 0.03, 0.125
"""Of the wheels, and their distance from the base's middle [m]."""
UPPER, FORE, HAND_AT = 0.12, 0.135, 0.06
"""Lengths [m] of the upper arm, of the forearm, and from the wrist to the hand's own body."""


def spec() -> mujoco.MjSpec:
    """Return the model, to be compiled."""
    made = mujoco.MjSpec()
    made.modelname = "omni5"
    made.compiler.degree = False
    base = made.worldbody.add_body(name="base")
    base.add_freejoint(name="free")
    cylinder(base, (0.0, 0.0, 0.085), 0.11, 0.02, 1.6)
    cylinder(base, (0.0, 0.0, 0.11), 0.1, 0.005, 0.3, DARK)
    for name, bearing in (("left", math.pi / 3.0), ("right", -math.pi / 3.0), ("rear", math.pi)):
        at = (AT * math.cos(bearing), AT * math.sin(bearing), RADIUS)
        omni_wheel(base, name, at, bearing + 0.5 * math.pi, RADIUS, WIDTH)

    shoulder = base.add_body(name="shoulder", pos=(0.04, 0.0, 0.115))
    hinge(shoulder, "arm_1", Z, -1.92, 1.92, 0.05)
    cylinder(shoulder, (0.0, 0.0, 0.02), 0.024, 0.02, 0.12, LIMB)
    upper = shoulder.add_body(name="upper_arm", pos=(0.0, 0.0, 0.055))
    hinge(upper, "arm_2", Y, -1.75, 1.75, 0.05)
    limb(upper, (0.0, 0.0, 0.0), (UPPER, 0.0, 0.0), 0.018, 0.12, BODY)
    fore = upper.add_body(name="forearm", pos=(UPPER, 0.0, 0.0))
    hinge(fore, "arm_3", Y, -0.1, 2.9, 0.05)
    limb(fore, (0.0, 0.0, 0.0), (FORE, 0.0, 0.0), 0.016, 0.12, LIMB)
    wrist = fore.add_body(name="wrist", pos=(FORE, 0.0, 0.0))
    hinge(wrist, "arm_4", Y, -1.7, 1.7, 0.03)
    limb(wrist, (0.0, 0.0, 0.0), (HAND_AT - 0.02, 0.0, 0.0), 0.014, 0.07, BODY)
    hand = wrist.add_body(name="hand", pos=(HAND_AT, 0.0, 0.0))
    hinge(hand, "arm_5", X, -2.8, 2.8, 0.02)
    box(hand, (0.0, 0.0, 0.0), (0.01, 0.026, 0.013), 0.05, HAND)
    fingers(hand, 0.01, 0.045, 0.02, 0.007)

    for name in ("left", "right", "rear"):
        velocity_motor(made, f"wheel_{name}", 2.0, 2.0)
    for name, most in (("1", 2.0), ("2", 3.0), ("3", 2.0), ("4", 1.2), ("5", 0.8)):
        velocity_motor(made, f"arm_{name}", 3.0, most)
    return made
