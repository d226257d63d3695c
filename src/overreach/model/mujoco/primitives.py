"""Robots of our own, made of boxes, cylinders and capsules: what they have in common."""

from __future__ import annotations

import math

import mujoco

Three = tuple[float, float, float]
Geom = mujoco.mjtGeom
ON_ITS_SIDE = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
"""Attitude of a wheel, whose axle is the base's y axis."""

BODY, LIMB, DARK, HAND = (
    (0.93, 0.93, 0.91, 1.0),
    (0.23, 0.45, 0.68, 1.0),
    (0.2, 0.21, 0.23, 1.0),
    (0.95, 0.55, 0.16, 1.0),
)
"""Colours (red, green, blue, opacity)."""


def box(body: mujoco.MjsBody, at: Three, half: Three, mass: float, rgba: tuple[float, ...] = BODY) -> None:
    """Add a box with these half lengths [m]."""
    body.add_geom(type=Geom.mjGEOM_BOX, pos=at, size=half, mass=mass, rgba=rgba)


def cylinder(
    body: mujoco.MjsBody, at: Three, radius: float, half: float, mass: float, rgba: tuple[float, ...] = BODY
) -> None:
    """Add an upright cylinder."""
    body.add_geom(type=Geom.mjGEOM_CYLINDER, pos=at, size=(radius, half, 0.0), mass=mass, rgba=rgba)


def limb(
    body: mujoco.MjsBody, start: Three, end: Three, radius: float, mass: float, rgba: tuple[float, ...] = LIMB
) -> None:
    """Add a capsule between two points."""
    body.add_geom(type=Geom.mjGEOM_CAPSULE, fromto=(*start, *end), size=(radius, 0.0, 0.0), mass=mass, rgba=rgba)


def hinge(body: mujoco.MjsBody, name: str, axis: Three, lower: float, upper: float, damping: float = 1.0) -> None:
    """Add a hinge with limits [rad]."""
    body.add_joint(
        name=name, type=mujoco.mjtJoint.mjJNT_HINGE, axis=axis, range=(lower, upper), damping=damping,
        limited=mujoco.mjtLimited.mjLIMITED_TRUE,
    )  # fmt: skip


def slide(body: mujoco.MjsBody, name: str, axis: Three, lower: float, upper: float, damping: float = 10.0) -> None:
    """Add a slide with limits [m]."""
    body.add_joint(
        name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis, range=(lower, upper), damping=damping,
        limited=mujoco.mjtLimited.mjLIMITED_TRUE,
    )  # fmt: skip


def wheel(base: mujoco.MjsBody, name: str, at: Three, radius: float, width: float, mass: float) -> None:
    """Add a driven wheel whose axle is the base's y axis."""
    body = base.add_body(name=f"{name}_wheel", pos=at)
    body.add_joint(name=f"wheel_{name}", type=mujoco.mjtJoint.mjJNT_HINGE, axis=(0.0, 1.0, 0.0), damping=0.02)
    body.add_geom(
        type=Geom.mjGEOM_CYLINDER, size=(radius, 0.5 * width, 0.0), quat=ON_ITS_SIDE, mass=mass, rgba=DARK, condim=4,
    )  # fmt: skip


def omni_wheel(base: mujoco.MjsBody, name: str, at: Three, heading: float, radius: float, width: float) -> None:
    """Add a driven wheel that rolls to `heading` [rad], without the rollers of a mecanum or omni wheel."""
    attitude = (math.cos(0.5 * heading), 0.0, 0.0, math.sin(0.5 * heading))
    body = base.add_body(name=f"{name}_wheel", pos=at, quat=attitude)
    body.add_joint(name=f"wheel_{name}", type=mujoco.mjtJoint.mjJNT_HINGE, axis=(0.0, 1.0, 0.0), damping=0.02)
    mass = 1e3 * math.pi * radius * radius * width
    body.add_geom(
        type=Geom.mjGEOM_CYLINDER, size=(radius, 0.5 * width, 0.0), quat=ON_ITS_SIDE, mass=mass, rgba=DARK,
    )  # fmt: skip


def caster(base: mujoco.MjsBody, name: str, at: Three, radius: float, trail: float) -> None:
    """Add a caster: a swivel about z, and a wheel that trails behind it."""
    fork = base.add_body(name=f"{name}_fork", pos=at)
    fork.add_joint(name=f"{name}_swivel", type=mujoco.mjtJoint.mjJNT_HINGE, axis=(0.0, 0.0, 1.0), damping=0.01)
    limb(fork, (0.0, 0.0, 0.0), (-trail, 0.0, radius - at[2]), 0.2 * radius, 0.1, DARK)
    roll = fork.add_body(name=f"{name}_roll", pos=(-trail, 0.0, radius - at[2]))
    roll.add_joint(name=f"{name}_roll", type=mujoco.mjtJoint.mjJNT_HINGE, axis=(0.0, 1.0, 0.0), damping=0.001)
    roll.add_geom(
        type=Geom.mjGEOM_CYLINDER, size=(radius, 0.4 * radius, 0.0),
        quat=ON_ITS_SIDE, mass=0.1, rgba=DARK,
    )  # fmt: skip


def fingers(hand: mujoco.MjsBody, ahead: float, length: float, opening: float, size: float) -> None:
    """Add two fingers that open along the hand's y axis, by `opening` [m] each; the hand's x axis is its approach."""
    for name, side in (("left", 1.0), ("right", -1.0)):
        finger = hand.add_body(name=f"finger_{name}", pos=(ahead, side * size, 0.0))
        slide(finger, f"finger_{name}", (0.0, side, 0.0), 0.0, opening)
        box(finger, (0.5 * length, 0.0, 0.0), (0.5 * length, 0.4 * size, size), 0.05, DARK)


def velocity_motor(spec: mujoco.MjSpec, joint: str, gain: float, most: float) -> None:
    """Add a motor that holds a joint's rate, with at most `most` [N m, N]."""
    motor = spec.add_actuator(name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    motor.set_to_velocity(kv=gain)
    motor.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
    motor.forcerange = (-most, most)
