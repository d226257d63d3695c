"""What a stream came to, by the forward kinematics of what happened, step by step."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from overreach.arm.spatial import task
from overreach.arm.spatial.manner import TOL_W
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.turning import apart, yawed
from overreach.check.driven import Driven
from overreach.check.streams import DT_S
from overreach.model.described import DescribedRobot
from overreach.verdicts import Verdict

TOL_V = 1e-3
"""A step is OK where its scale is 1, or the hand waits for a base that swings, and where its velocity is off from its
part of the command by at most this [m/s], and its attitude by TOL_W [rad]."""
LOOK = 50
"""Contacts are looked for in one step of so many."""
HALF = 0.5


class Judged(NamedTuple):
    """One stream. ok (N,): whether each step was; off_v [m/s], off_w [rad] (N,): its errors; the rest are numbers."""

    ok: Array
    off_v: Array
    off_w: Array
    scale: Array
    speed: Array
    based: float
    crossings: int
    violations: int
    gap: float
    contacts: int
    lateral: float
    out_l: float
    out_psi: float
    out_z: float


def judge(model: DescribedRobot, driven: Driven, touching: Callable[[Array], bool]) -> Judged:
    """Return what a stream came to; touching: whether joints (n,) bring the robot into contact with itself."""
    arm, space = model.arm, model.workspace
    R, p, _ = arm.posture_at_home.forward(driven.q)
    l, psi, z = np.hypot(p[:, 0], p[:, 1]), np.arctan2(p[:, 1], p[:, 0]), p[:, 2]
    x, y = in_world(model, driven.base, p)
    moved = np.stack((np.diff(x), np.diff(y), np.diff(z)), axis=1) / DT_S
    off_v = np.linalg.norm(moved - driven.scale[:, None] * driven.u, axis=1)
    off_w = _turned_off(model, driven, R, psi)[1:]
    waits = np.array([verdict == Verdict.SWINGING for verdict in driven.verdicts])
    whole = (driven.scale >= 1.0 - 1e-9) | waits
    ok = whole & (off_v <= TOL_V) & (off_w <= TOL_W)
    lower, upper = arm.limits[:, 0], arm.limits[:, 1]
    gap = np.minimum(driven.q - lower, upper - driven.q)
    over = driven.mu > HALF
    return Judged(
        ok=ok,
        off_v=off_v,
        off_w=off_w,
        scale=driven.scale,
        speed=np.linalg.norm(driven.u, axis=1),
        based=float(np.mean(over)),
        crossings=int(np.count_nonzero(np.diff(over)) + np.count_nonzero(np.diff(driven.sigma > HALF))),
        violations=int(np.count_nonzero(gap < 0.0)),
        gap=float(gap.min()),
        contacts=sum(touching(q) for q in driven.q[::LOOK]),
        lateral=float(np.abs(driven.twist[:, 1]).max()),
        out_l=_beyond(l, space.l_min, space.l_max),
        out_psi=_beyond(psi, space.psi_min, space.psi_max),
        out_z=_beyond(z, space.z_min, space.z_max),
    )


def in_world(model: DescribedRobot, base: Array, p: Array) -> tuple[Array, Array]:
    """Return the hand's (x, y) in the world, for base poses (N, 3) and places (N, 3) in the arm's frame."""
    turn = base[:, 2] + model.mount.yaw
    c, s = np.cos(base[:, 2]), np.sin(base[:, 2])
    s_x, s_y = model.mount.s_x, model.mount.s_y
    x = base[:, 0] + c * s_x - s * s_y + np.cos(turn) * p[:, 0] - np.sin(turn) * p[:, 1]
    y = base[:, 1] + s * s_x + c * s_y + np.sin(turn) * p[:, 0] + np.cos(turn) * p[:, 1]
    return x, y


def _turned_off(model: DescribedRobot, driven: Driven, R: Array, psi: Array) -> Array:
    """Return how far [rad] the turnings that are held are off, at each state."""
    arm = model.arm
    manner, R_home = arm.manner, arm.R_home.ravel()
    bearing = driven.base[:, 2] + model.mount.yaw + psi
    heading = _headings(model, driven, bearing) if manner.yaw > 0.0 else bearing
    off = np.empty(len(R))
    T = np.empty((task.count(manner.held), 6))
    approach, goal, e = np.array(manner.approach), np.empty(9), np.empty(3)
    for k in range(len(R)):
        f = 0.0
        if manner.yaw > 0.0:
            delta = float((heading[k] - bearing[k] + np.pi) % (2.0 * np.pi) - np.pi)
            f, _ = task.yielding(delta, manner.yaw)
        yawed(R_home, psi[k] + f, goal)
        angle = apart(goal, R[k].ravel(), e)
        task.rows(manner.held, psi[k], goal, approach, 1.0, T)
        folded = manner.held == task.PITCH and angle > task.FOLDED
        off[k] = angle if folded else np.linalg.norm(T[3:, 3:] @ e)
    return off


def _headings(model: DescribedRobot, driven: Driven, bearing: Array) -> Array:
    """Return the heading [rad] that a fixed yaw comes from, at each state: each motion begins with that of its hand."""
    rests = np.append((driven.u == 0.0).all(axis=1) & (driven.w == 0.0), False)
    turned = driven.w * driven.scale * DT_S
    heading = np.empty(len(bearing))
    for k in range(len(bearing)):
        if k == 0 or rests[k - 1]:
            heading[k] = bearing[k] + model.arm.at(tuple(driven.q[k].tolist()), model.mount).heading()
        else:
            heading[k] = heading[k - 1] + turned[k - 1]
    return heading


def _beyond(values: Array, low: float, high: float) -> float:
    return max(0.0, float(values.max()) - high, low - float(values.min()))
