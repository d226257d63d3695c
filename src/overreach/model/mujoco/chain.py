"""The screws of an arm, taken once from a compiled model with its joints at zero."""

from __future__ import annotations

from typing import NamedTuple

import mujoco
import numpy as np

from overreach.arm.mount import Mount
from overreach.arm.spatial.screws import Array, forward
from overreach.errors import SetupError
from overreach.model.description import Description, MountTable

STRAIGHT = 1e-6
HINGE, SLIDE = int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)


class Extracted(NamedTuple):
    """An arm as it is in a model: where it stands, its screws and hand in the arm's frame, its joints' limits.

    aside: whether it cannot move its hand about the shoulder.
    """

    mount: Mount
    screws: Array
    tip: Array
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    units: tuple[str, ...]
    aside: bool


def extract(model: mujoco.MjModel, description: Description) -> Extracted:
    """Return the arm of `description` in its compiled model; raises SetupError for what is not there."""
    joints = [[joint_of(model, name) for name in group] for group in description.arm.groups]
    base, hand = body_of(model, description.base.body, "base.body"), body_of(model, description.hand.body, "hand.body")
    _check_order(model, description, joints, base, hand)
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos0
    lock(model, data, description)
    for group in joints:
        for joint in group:
            data.qpos[model.jnt_qposadr[joint]] = 0.0
    mujoco.mj_kinematics(model, data)
    R_b, p_b = base_frame(model, data, description)
    n = len(joints)
    screws = np.zeros((n, 7))
    lower, upper, units = [], [], []
    for k, group in enumerate(joints):
        first = group[0]
        slide = int(model.jnt_type[first]) == SLIDE
        screws[k, :3] = R_b.T @ data.xaxis[first]
        screws[k, 3:6] = R_b.T @ (data.xanchor[first] - p_b)
        screws[k, 6] = float(slide)
        limits = [model.jnt_range[joint] for joint in group if model.jnt_limited[joint]]
        # Coupled joints go alike: the one with the least room limits all.
        lower.append(len(group) * max((float(least) for least, _ in limits), default=-ENDLESS))
        upper.append(len(group) * min((float(most) for _, most in limits), default=ENDLESS))
        units.append("m" if slide else "rad")
        for other in group[1:]:
            if float(screws[k, :3] @ (R_b.T @ data.xaxis[other])) < 1.0 - STRAIGHT or not slide:
                raise SetupError(f"arm.joints: {', '.join(description.arm.groups[k])} do not slide along one axis")
    hinges = [k for k in range(n) if not screws[k, 6]]
    if not hinges:
        raise SetupError("arm.joints: an arm needs at least one hinge")
    R_h = data.xmat[hand].reshape(3, 3)
    p_h = R_b.T @ (data.xpos[hand] + R_h @ np.array(description.hand.offset) - p_b)
    tip = np.concatenate(((R_b.T @ R_h).ravel(), p_h))
    one_way = only_way(screws, tip, description)
    mount = mount_of(description.mount, screws[hinges[0], 3:5], one_way)
    c, s = np.cos(mount.yaw), np.sin(mount.yaw)
    turn = np.array(((c, s, 0.0), (-s, c, 0.0), (0.0, 0.0, 1.0)))  # base axes -> arm axes
    s_x, s_y = mount.s_x, mount.s_y
    shift = np.array((s_x, s_y, 0.0))
    screws[:, :3] = screws[:, :3] @ turn.T
    screws[:, 3:6] = (screws[:, 3:6] - shift) @ turn.T
    tip = np.concatenate(((turn @ R_b.T @ R_h).ravel(), turn @ (p_h - shift)))
    return Extracted(mount, screws, tip, tuple(lower), tuple(upper), tuple(units), one_way is not None)


class OneWay(NamedTuple):
    """The only way in which an arm moves its hand along the ground. yaw: where it goes [rad]; hand (2,) [m] at home."""

    yaw: float
    hand: Array


def only_way(screws: Array, tip: Array, description: Description) -> OneWay | None:
    """Return the only way in which an arm moves its hand along the ground at home, if that is a slide's; else None.

    screws, tip: along the base's axes. An arm of hinges that is stretched out has only one way too, but to its side.
    """
    n = len(screws)
    hand, J, places = np.empty(12), np.empty((6, n)), np.empty((n, 3))
    forward(screws, tip, np.array(description.home), hand, J, places)
    ways, levers, _ = np.linalg.svd(J[:2])
    way = ways[:, 0] * (1.0 if float(ways[:, 0] @ hand[9:11]) >= 0.0 else -1.0)
    if len(levers) > 1 and levers[1] > ONE_WAY * float(way @ hand[9:11]):
        return None
    slides = any(screws[k, 6] and abs(float(way @ J[:2, k])) > ALONG for k in range(n))
    return OneWay(float(np.arctan2(way[1], way[0])), hand[9:11].copy()) if slides else None


def mount_of(table: MountTable, hinge: Array, one_way: OneWay | None) -> Mount:
    """Return where an arm stands: as described; else at its first hinge, or where its only way begins.

    That is the point of its line that is nearest to the base's turning centre.
    """
    if one_way is None:
        x, y, yaw = float(hinge[0]), float(hinge[1]), 0.0
    else:
        way = np.array((np.cos(one_way.yaw), np.sin(one_way.yaw)))
        x, y = (one_way.hand - float(one_way.hand @ way) * way).tolist()
        yaw = one_way.yaw
    s_x, s_y = x if table.s_x is None else table.s_x, y if table.s_y is None else table.s_y
    return Mount(s_x, s_y, yaw if table.yaw is None else table.yaw)


ONE_WAY = 0.2
"""Hinges that move the hand in another way have levers of at most this part of its distance: a wrist's, no arm's."""
ALONG = 0.99
"""A slide is along a way where its axis has this much of it."""


def _check_order(
    model: mujoco.MjModel, description: Description, joints: list[list[int]], base: int, hand: int
) -> None:
    """Raise SetupError unless the joints carry the hand, from the base outward, each once."""
    path = [hand]
    while path[-1] not in (0, base):
        path.append(int(model.body_parentid[path[-1]]))
    if path[-1] != base:
        raise SetupError(f"hand.body: {description.hand.body!r} is not carried by base.body, {description.base.body!r}")
    outward = [j for body in reversed(path[:-1]) for j in range(model.njnt) if int(model.jnt_bodyid[j]) == body]
    for joint in outward:
        if (name := model.joint(joint).name) in description.others:
            raise SetupError(
                f"hands.{description.driven}: joint {name!r} carries this hand too, but is only among another's: put "
                "it into the joints of both"
            )
    given = [joint for group in joints for joint in group]
    names = [model.joint(joint).name for joint in given]
    for joint, name in zip(given, names, strict=True):
        if joint not in outward:
            raise SetupError(f"arm.joints: {name!r} does not carry the hand, {description.hand.body!r}")
    ordered = [joint for joint in outward if joint in given]
    if given != ordered:
        right = ", ".join(model.joint(joint).name for joint in ordered)
        raise SetupError(f"arm.joints must be each once, from the base outward: {right}; got {', '.join(names)}")


ENDLESS = 1e3
"""Limit of a joint that has none [rad]."""


def base_frame(model: mujoco.MjModel, data: mujoco.MjData, description: Description) -> tuple[Array, Array]:
    """Return the base's frame in the model's world, x where it drives to: axes as columns (3, 3), origin (3,) [m]."""
    body = body_of(model, description.base.body, "base.body")
    c, s = np.cos(description.base.heading), np.sin(description.base.heading)
    R = data.xmat[body].reshape(3, 3)
    if description.base.heading != 0.0:
        R = R @ np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))
    return np.array(R), np.array(data.xpos[body])


def lock(model: mujoco.MjModel, data: mujoco.MjData, description: Description) -> None:
    """Put the joints that stay where they are there."""
    for name, value in description.locked.items():
        data.qpos[model.jnt_qposadr[joint_of(model, name)]] = value


def joint_of(model: mujoco.MjModel, name: str) -> int:
    """Return the number of the joint called `name`; raises SetupError with the names that there are."""
    k = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)
    if k < 0:
        names = [model.joint(j).name for j in range(model.njnt)]
        raise SetupError(f"arm.joints: the model has no joint {name!r}; it has {', '.join(names)}")
    if int(model.jnt_type[k]) not in (HINGE, SLIDE):
        raise SetupError(f"arm.joints: {name!r} is neither a hinge nor a slide")
    return int(k)


def body_of(model: mujoco.MjModel, name: str, what: str) -> int:
    """Return the number of the body called `name`; raises SetupError with the names that there are."""
    k = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
    if k < 0:
        names = [model.body(j).name for j in range(1, model.nbody)]
        raise SetupError(f"{what}: the model has no body {name!r}; it has {', '.join(names)}")
    return int(k)
