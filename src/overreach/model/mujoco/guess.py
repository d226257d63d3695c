"""What a robot's model file has, as far as it can be guessed from it alone.

base    the free body, or the root; the frame on the ground, if one carries it; its wheels the endless hinges whose axis
        is level, on it or on its suspension
arm     the longest chain of hinges and slides, neither wheels nor fingers, from the base to a hand: up to where it
        branches into fingers; a lift that is slower than the hand is to go up and down is locked midway
hand    the body at its end, as far out as its fingers are; their joints, its gripper
"""

from __future__ import annotations

import math
from typing import NamedTuple

import mujoco
import numpy as np

from overreach.errors import SetupError

LEVEL = 0.1
"""An axis is level, or upright, within this."""
FINGER = 0.2
"""A slide with less travel than this [m], at the end of a chain, is a finger's."""
OMNI = 3
"""A base that moves sideways has so many wheels at least ..."""
ONE_WAY = 0.9
"""... whose axes' cosine to the first's is not all above this."""
USUAL_SPEED, USUAL_LIFT = 1.5, 0.1
"""Joint speeds [rad/s, m/s] where the model has none: to be looked up."""
SLOW_LIFT = 0.08
"""A slide at the beginning of an arm that is slower than this [m/s] would leave the posture behind: it is locked."""
SHORTEST = 3
"""An arm has so many joints at least."""
NOT_AN_ARM = ("head", "wheel", "caster", "finger", "gripper", "camera", "neck", "pan_tilt", "leg")
RIGHT = ("right", "_r_")


class Guess(NamedTuple):
    """What was found: names in the model, and where they were only guessed."""

    base: str
    kind: str
    wheels: tuple[str, ...]
    joints: tuple[str, ...]
    hand: str
    approach: tuple[float, float, float]
    ahead: float
    locked: tuple[str, ...]
    gripper: tuple[str, ...]
    speeds: tuple[tuple[float, bool], ...]
    footprint: tuple[float, float]
    chains: tuple[str, ...]


def guess(model: mujoco.MjModel, speeds: dict[str, float], what: str) -> Guess:
    """Return what a model has; raises SetupError where it has no base, or no arm on it."""
    base = _base(model, what)
    hinges = [j for j in range(model.njnt) if int(model.jnt_type[j]) == int(mujoco.mjtJoint.mjJNT_HINGE)]
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos0
    mujoco.mj_kinematics(model, data)
    up = data.xmat[base].reshape(3, 3)[:, 2]
    endless = [j for j in hinges if not model.jnt_limited[j]]
    wheels = [
        j for j in endless
        if _above(model, int(model.jnt_bodyid[j]), base) and abs(float(data.xaxis[j] @ up)) < LEVEL
        and not set(_joints_to(model, int(model.jnt_bodyid[j]), base)[:-1]) & set(hinges)
    ]  # fmt: skip
    chain, others = _arm(model, base, set(wheels), what)
    last = int(model.jnt_bodyid[chain[-1]])
    fingers = [j for j in range(model.njnt) if j not in chain and _above(model, int(model.jnt_bodyid[j]), last)]
    slides = {j for j in chain if int(model.jnt_type[j]) == int(mujoco.mjtJoint.mjJNT_SLIDE)}
    slow = [j for j in chain if j in slides and speeds.get(model.joint(j).name, USUAL_LIFT) < SLOW_LIFT]
    locked = tuple(model.joint(j).name for j in slow if chain.index(j) < chain.index(_first(chain, slides)))
    chain = [j for j in chain if model.joint(j).name not in locked]
    names = [model.joint(j).name for j in chain]
    approach = _approach(model, data, last)
    found = []
    for j, name in zip(chain, names, strict=True):
        slide = j in slides
        found.append((speeds[name], True) if name in speeds else (USUAL_LIFT if slide else USUAL_SPEED, False))
    return Guess(
        base=model.body(base).name,
        kind="omni" if _omni(data, wheels) else "differential",
        wheels=tuple(model.joint(j).name for j in wheels),
        joints=tuple(names),
        hand=model.body(last).name,
        approach=approach,
        ahead=_ahead(model, data, last, fingers, approach),
        locked=locked,
        gripper=tuple(model.joint(j).name for j in fingers),
        speeds=tuple(found),
        footprint=_footprint(model, data, base),
        chains=tuple(others),
    )


def _first(chain: list[int], slides: set[int]) -> int:
    """Return the first joint of a chain that is a hinge, or its last."""
    return next((j for j in chain if j not in slides), chain[-1])


def _ahead(
    model: mujoco.MjModel, data: mujoco.MjData, hand: int, fingers: list[int], approach: tuple[float, float, float]
) -> float:
    """Return how far along its approach axis the hand's fingers are [m]: 0 where it has none."""
    if not fingers:
        return 0.0
    away = np.mean([data.xanchor[j] for j in fingers], axis=0) - data.xpos[hand]
    return max(0.0, round(float(data.xmat[hand].reshape(3, 3).T @ away @ approach), 3))


def _omni(data: mujoco.MjData, wheels: list[int]) -> bool:
    """Say whether wheels are those of a base that moves sideways: three or more, and not all of them roll one way."""
    axes = [data.xaxis[j] for j in wheels]
    return len(axes) >= OMNI and any(abs(float(axes[0] @ axis)) < ONE_WAY for axis in axes)


def _base(model: mujoco.MjModel, what: str) -> int:
    free = [j for j in range(model.njnt) if int(model.jnt_type[j]) == int(mujoco.mjtJoint.mjJNT_FREE)]
    if free:
        return int(model.jnt_bodyid[free[0]])
    roots = [b for b in range(1, model.nbody) if int(model.body_parentid[b]) == 0]
    carrying = [b for b in roots if any(_above(model, int(model.jnt_bodyid[j]), b) for j in range(model.njnt))]
    if not carrying:
        raise SetupError(f"{what} has no base: no body that carries joints")
    root = carrying[0]
    named = {
        part: next((b for b in range(1, model.nbody) if part in model.body(b).name and _above(model, b, root)), 0)
        for part in ("base_footprint", "base_link")
    }
    foot, link = named["base_footprint"], named["base_link"]
    if foot and (not link or _above(model, link, foot)):  # it is on the ground, and carries the base
        return foot
    return link or root  # a root may be a bare frame above the base


def _above(model: mujoco.MjModel, body: int, root: int) -> bool:
    while body > 0:
        if body == root:
            return True
        body = int(model.body_parentid[body])
    return False


def _joints_to(model: mujoco.MjModel, body: int, base: int) -> list[int]:
    """Return the joints from the base out to a body."""
    found: list[int] = []
    while body > 0 and body != base:
        first, many = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        found = [*range(first, first + many), *found]
        body = int(model.body_parentid[body])
    return found


def _arm(model: mujoco.MjModel, base: int, wheels: set[int], what: str) -> tuple[list[int], list[str]]:
    """Return the joints of the longest chain that looks like an arm, and the names of the ends of the others."""
    chains: list[tuple[int, list[int]]] = []
    for body in range(1, model.nbody):
        if _above(model, body, base) and body not in model.body_parentid:
            joints = _joints_to(model, body, base)
            joints = joints[: _palm(model, joints)]
            while joints and _is_finger(model, joints[-1]):
                joints.pop()
            if len(joints) >= SHORTEST and not wheels & set(joints) and not _named(model, joints):
                chains.append((body, joints))
    if not chains:
        raise SetupError(f"{what} has no arm: no chain of three joints or more on the base")
    longest = max(len(joints) for _, joints in chains)
    best = [chain for chain in chains if len(chain[1]) == longest]
    left = [chain for chain in best if not any(mark in model.body(chain[0]).name for mark in RIGHT)]
    chosen = (left or best)[0][1]
    ends = {model.body(int(model.jnt_bodyid[joints[-1]])).name for _, joints in chains if joints != chosen}
    return chosen, sorted(ends)


def _palm(model: mujoco.MjModel, joints: list[int]) -> int:
    """Return how many joints of a chain there are up to the one, behind the third, that carries several."""
    carried_by = [joint for j in range(model.njnt) for joint in _joints_to(model, int(model.jnt_bodyid[j]), 0)[-2:-1]]
    for k, joint in enumerate(joints, start=1):
        if k > SHORTEST and carried_by.count(joint) > 1:
            return k
    return len(joints)


def _is_finger(model: mujoco.MjModel, joint: int) -> bool:
    slide = int(model.jnt_type[joint]) == int(mujoco.mjtJoint.mjJNT_SLIDE)
    travel = float(model.jnt_range[joint][1] - model.jnt_range[joint][0])
    return (slide and travel < FINGER) or any(
        word in model.joint(joint).name.lower() for word in ("finger", "gripper", "thumb")
    )


def _named(model: mujoco.MjModel, joints: list[int]) -> bool:
    """Say whether a chain is called something else than an arm."""
    return any(word in model.joint(joints[-1]).name.lower() for word in NOT_AN_ARM)


def _approach(model: mujoco.MjModel, data: mujoco.MjData, hand: int) -> tuple[float, float, float]:
    """Return the axis of the hand's body along which its fingers, or its own geometry, lie."""
    points = [data.xpos[b] for b in range(model.nbody) if int(model.body_parentid[b]) == hand]
    points += [data.geom_xpos[g] for g in range(model.ngeom) if int(model.geom_bodyid[g]) == hand]
    away = np.mean(points, axis=0) - data.xpos[hand] if points else np.zeros(3)
    if float(np.linalg.norm(away)) < 1e-3:
        away = data.xpos[hand] - data.xpos[int(model.body_parentid[hand])]
    own = data.xmat[hand].reshape(3, 3).T @ away
    axis = int(np.argmax(np.abs(own)))
    unit = [0.0, 0.0, 0.0]
    unit[axis] = math.copysign(1.0, float(own[axis]))
    return unit[0], unit[1], unit[2]


def _footprint(model: mujoco.MjModel, data: mujoco.MjData, base: int) -> tuple[float, float]:
    """Return length and width [m] of what is fixed to the base."""
    half = np.zeros(2)
    rigid = [b for b in range(1, model.nbody) if _above(model, b, base) and not _joints_to(model, b, base)]
    R, p = data.xmat[base].reshape(3, 3), data.xpos[base]
    for geom in range(model.ngeom):
        if int(model.geom_bodyid[geom]) in rigid:
            at = R.T @ (data.geom_xpos[geom] - p)
            turn = np.abs(R.T @ data.geom_xmat[geom].reshape(3, 3))
            reach = np.abs(at) + turn @ (np.abs(model.geom_aabb[geom, :3]) + model.geom_aabb[geom, 3:])
            half = np.maximum(half, reach[:2])
    length, width = (2.0 * half).tolist()
    return (round(length, 2) or 0.5), (round(width, 2) or 0.5)
