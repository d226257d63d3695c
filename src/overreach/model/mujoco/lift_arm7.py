"""A column with a lift, an arm of seven joints that reaches 0.8 m, and a gripper: on the bases of mobile7 and omni7."""

from __future__ import annotations

import mujoco

from overreach.model.mujoco.primitives import (
    BODY,
    HAND,
    LIMB,
    box,
    cylinder,
    fingers,
    hinge,
    limb,
    slide,
    velocity_motor,
)  # fmt: skip

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
UPPER, FORE, HAND_AT = 0.35, 0.32, 0.08
"""Lengths [m] of the upper arm, of the forearm, and from the wrist to the hand's own body."""


def add_arm(base: mujoco.MjsBody) -> None:
    """Add the column, its lift, and the arm to the body of a base whose top is 0.28 m above the ground."""
    box(base, (-0.06, 0.0, 0.58), (0.07, 0.09, 0.3), 7.0)
    carriage = base.add_body(name="carriage", pos=(0.04, 0.0, 0.55))
    slide(carriage, "lift", Z, 0.0, 0.4, damping=200.0)
    box(carriage, (-0.01, 0.0, -0.03), (0.02, 0.08, 0.06), 3.0, LIMB)
    shoulder = carriage.add_body(name="shoulder", pos=(0.08, 0.0, 0.0))
    hinge(shoulder, "arm_1", Z, -2.6, 2.6, 2.0)
    cylinder(shoulder, (0.0, 0.0, 0.02), 0.055, 0.05, 2.2, LIMB)
    upper = shoulder.add_body(name="upper_arm", pos=(0.0, 0.0, 0.1))
    hinge(upper, "arm_2", Y, -1.7, 2.1, 2.0)
    limb(upper, (0.0, 0.0, 0.0), (0.5 * UPPER, 0.0, 0.0), 0.05, 1.6, BODY)
    turn = upper.add_body(name="upper_arm_roll", pos=(0.5 * UPPER, 0.0, 0.0))
    hinge(turn, "arm_3", X, -2.9, 2.9, 1.0)
    limb(turn, (0.0, 0.0, 0.0), (0.5 * UPPER, 0.0, 0.0), 0.046, 1.3, LIMB)
    fore = turn.add_body(name="forearm", pos=(0.5 * UPPER, 0.0, 0.0))
    hinge(fore, "arm_4", Y, -0.1, 2.55, 1.0)
    limb(fore, (0.0, 0.0, 0.0), (0.5 * FORE, 0.0, 0.0), 0.042, 1.0, BODY)
    roll = fore.add_body(name="forearm_roll", pos=(0.5 * FORE, 0.0, 0.0))
    hinge(roll, "arm_5", X, -2.9, 2.9, 0.5)
    limb(roll, (0.0, 0.0, 0.0), (0.5 * FORE, 0.0, 0.0), 0.038, 0.8, LIMB)
    wrist = roll.add_body(name="wrist", pos=(0.5 * FORE, 0.0, 0.0))
    hinge(wrist, "arm_6", Y, -2.0, 2.0, 0.5)
    limb(wrist, (0.0, 0.0, 0.0), (HAND_AT, 0.0, 0.0), 0.034, 0.5, BODY)
    hand = wrist.add_body(name="hand", pos=(HAND_AT, 0.0, 0.0))
    hinge(hand, "arm_7", X, -2.9, 2.9, 0.2)
    box(hand, (0.02, 0.0, 0.0), (0.02, 0.05, 0.025), 0.3, HAND)
    fingers(hand, 0.04, 0.06, 0.035, 0.014)


def add_motors(made: mujoco.MjSpec) -> None:
    """Add a motor for the lift and for each joint of the arm."""
    velocity_motor(made, "lift", 8000.0, 800.0)
    for name, gain, most in (
        ("1", 300.0, 80.0),
        ("2", 300.0, 80.0),
        ("3", 200.0, 45.0),
        ("4", 200.0, 45.0),
        ("5", 60.0, 15.0),
        ("6", 60.0, 15.0),
        ("7", 30.0, 8.0),
    ):
        velocity_motor(made, f"arm_{name}", gain, most)
