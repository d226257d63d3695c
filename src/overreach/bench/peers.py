"""What one would use instead on an arm in space: mink's differential inverse kinematics, with daqp.

As its published examples of mobile arms set it up: a frame task of the hand, a slight posture task, a damped base,
limits of joints and of speeds. `whole`: the robot's model as it ships, on its free base; `chain`: the base as x, y and
yaw, and the arm's joints, nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import mink
import mujoco
import numpy as np

from overreach.arm.spatial.screws import Array
from overreach.check.streams import DT_S
from overreach.model.mujoco.chain import joint_of
from overreach.model.mujoco.robot import Parts

SOLVER = "daqp"
POSTURE, BASE, LM, DAMPING = 1e-3, 0.1, 1.0, 1e-5
"""Costs of the posture and of the base's motion, and the two dampings."""


class Peer(NamedTuple):
    """A name, and (joints, wanted velocity of the hand [m/s]) -> rates."""

    name: str
    solve: Callable[[Array, Array], Array]


def peers(parts: Parts) -> list[Peer]:
    """Return mink on the whole model and on the chain alone."""
    joints = [group[0] for group in parts.description.arm.groups]
    speeds = {name: channel.rate_max for name, channel in zip(joints, parts.arm.channels, strict=True)}
    whole = parts.model
    free = [j for j in range(whole.njnt) if int(whole.jnt_type[j]) == int(mujoco.mjtJoint.mjJNT_FREE)]
    base = list(range(int(whole.jnt_dofadr[free[0]]), int(whole.jnt_dofadr[free[0]]) + 6)) if free else []
    chain = chain_of(parts, joints)
    return [
        Peer("mink + daqp, whole model", _solver(whole, joints, speeds, base, ("body", parts.description.hand.body))),
        Peer("mink + daqp, chain only", _solver(chain, joints, speeds, [0, 1, 2], ("site", "hand"))),
    ]


def chain_of(parts: Parts, joints: list[str]) -> mujoco.MjModel:
    """Return the base as two slides and a hinge, with the arm's joints on it and a site at the hand."""
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    body = spec.worldbody
    hinge, slide = mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE
    for name, kind, axis in (
        ("base_x", slide, (1, 0, 0)),
        ("base_y", slide, (0, 1, 0)),
        ("base_yaw", hinge, (0, 0, 1)),
    ):
        body = _link(body, name, kind, axis, (0.0, 0.0, 0.0))
    for name, screw, channel in zip(joints, parts.arm.screws.tolist(), parts.arm.channels, strict=True):
        body = _link(body, name, slide if screw[6] else hinge, screw[:3], screw[3:6], (channel.lower, channel.upper))
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, parts.arm.tip[:9])
    body.add_site(name="hand", pos=parts.arm.tip[9:].tolist(), quat=quat.tolist())
    return spec.compile()


def _link(
    parent: mujoco.MjsBody, name: str, kind: int, axis: object, at: object, limits: tuple[float, float] | None = None
) -> mujoco.MjsBody:
    body = parent.add_body(name=name)
    body.mass, body.inertia, body.explicitinertial = 1.0, [1.0, 1.0, 1.0], True
    joint = body.add_joint(name=name, type=kind, axis=axis, pos=at)
    if limits is not None:
        joint.range, joint.limited = limits, mujoco.mjtLimited.mjLIMITED_TRUE
    return body


def _solver(
    model: mujoco.MjModel, joints: list[str], speeds: dict[str, float], base: list[int], hand: tuple[str, str]
) -> Callable[[Array, Array], Array]:
    """Return the solve: configuration at the joints, target one period ahead, rates of everything."""
    configuration = mink.Configuration(model)
    addresses = model.jnt_qposadr[[joint_of(model, name) for name in joints]]
    q_all = model.qpos0.copy()
    kind, name = hand
    task = mink.FrameTask(name, kind, position_cost=1.0, orientation_cost=1.0, lm_damping=LM)
    posture = mink.PostureTask(model, cost=POSTURE)
    costs = np.zeros(model.nv)
    costs[base] = BASE
    damped = mink.DampingTask(model, cost=costs)
    limits = [mink.ConfigurationLimit(model), mink.VelocityLimit(model, speeds)]
    posture.set_target_from_configuration(configuration)
    tasks = [task, posture, damped]

    def solve(q: Array, u: Array) -> Array:
        q_all[addresses] = q
        configuration.update(q_all)
        task.set_target_from_configuration(configuration)
        ahead = mink.SE3.from_translation(u * DT_S)
        task.set_target(ahead.multiply(task.transform_target_to_world))  # type: ignore[arg-type]  # it was just set
        rates: Array = mink.solve_ik(configuration, tasks, DT_S, solver=SOLVER, damping=DAMPING, limits=limits)
        return rates

    return solve
