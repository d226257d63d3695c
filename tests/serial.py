"""A second kind of arm: any chain of axes and anchors in space, by damped least squares. And a robot that has one."""

from __future__ import annotations

import math
from typing import Any, final

import msgspec
import numpy as np

from overreach.arm.chain import Moved, Point, Rest
from overreach.arm.mount import Mount
from overreach.arm.polar import wrap
from overreach.gate.limits import Limits
from overreach.model.base import Base, Start
from overreach.model.workspace import Workspace
from overreach.types import Channel, Record
from overreach.verdicts import Verdict

Array = Any
DAMPING = 1e-12
"""lambda^2 of the inverse: of no weight away from singularities."""


def skew(w: Array) -> Array:
    return np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])


def turned(w: Array) -> Array:
    """Return the rotation by the vector w [rad] (Rodrigues)."""
    angle = float(np.linalg.norm(w))
    if angle < 1e-12:
        return np.eye(3) + skew(w)
    k = skew(w / angle)
    return np.eye(3) + math.sin(angle) * k + (1.0 - math.cos(angle)) * (k @ k)


def vector(R: Array) -> Array:
    """Return the rotation vector of R [rad]: the logarithm."""
    axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    angle = math.atan2(0.5 * float(np.linalg.norm(axis)), 0.5 * (float(np.trace(R)) - 1.0))
    return 0.5 * axis if angle < 1e-9 else axis * (0.5 * angle / math.sin(angle))


@final
class SerialArm:
    """Hinges by axis and anchor, with all joints at 0, in the arm's own frame: origin under the shoulder, x ahead."""

    rows = (0, 1, 2, 3, 4, 5)

    def __init__(
        self, axes: list[Point], anchors: list[Point], hand: Point, home: tuple[float, ...], whole: bool = True
    ) -> None:
        self.axes, self.anchors = [np.array(axis) for axis in axes], [np.array(anchor) for anchor in anchors]
        self.hand, self.home, self.whole = np.array(hand), home, whole
        self.channels = tuple(
            Channel(f"dq_{k}", f"q_{k}", "rad", 6.0, 60.0, -6.0, 6.0) for k in range(1, len(axes) + 1)
        )
        self.branch = tuple((-6.0, 6.0) for _ in axes)
        self.reach = (0.1, 1.2)

    def at(self, joints: tuple[float, ...], mount: Mount) -> SerialChain:
        return SerialChain(self, joints, mount)

    def posture(self, l: float, psi: float) -> tuple[float, ...]:
        """Return joints that put the hand at (l, psi), at its home's height and attitude to the bearing."""
        chain = self.at(self.home, Mount())
        R = turned(np.array([0.0, 0.0, psi - chain.psi])) @ chain.R
        goal = np.array([l * math.cos(psi), l * math.sin(psi), chain.p[2]])
        for _ in range(200):
            error = np.concatenate((goal - chain.p, vector(R @ chain.R.T)))
            if np.abs(error).max() < 1e-13:
                break
            chain = self.at(tuple(np.array(chain.joints) + 0.3 * chain.solved(error) if np.abs(error).max() > 0.01
                                  else np.array(chain.joints) + chain.solved(error)), Mount())  # fmt: skip
        return tuple(float(angle) for angle in chain.joints)


@final
class SerialChain:
    """The arm at its joints; see `overreach.arm.chain.Chain`."""

    def __init__(self, arm: SerialArm, joints: tuple[float, ...], mount: Mount) -> None:
        self.arm, self.joints, self.mount = arm, joints, mount
        R, p = np.eye(3), np.zeros(3)
        axes, anchors = [], []
        for axis, anchor, angle in zip(arm.axes, arm.anchors, joints, strict=True):
            axes.append(R @ axis)
            anchors.append(p + R @ anchor)
            turn = turned(axis * angle)
            p = p + R @ (anchor - turn @ anchor)
            R = R @ turn
        self.R, self.p = R, p + R @ arm.hand
        self.places = [*anchors, self.p]
        self.J: Array = np.vstack(
            (
                np.column_stack([np.cross(w, self.p - a) for w, a in zip(axes, anchors, strict=True)]),
                np.column_stack(axes),
            )
        )
        self.l = math.hypot(self.p[0], self.p[1])
        self.psi = wrap(math.atan2(self.p[1], self.p[0]))

    def solved(self, x: Array) -> Array:
        """Return J^T (J J^T + lambda^2 I)^-1 x, with x along the arm's axes."""
        return self.J.T @ np.linalg.solve(self.J @ self.J.T + DAMPING * np.eye(6), x)

    @property
    def polar(self) -> Array:
        """The rows r, t, z."""
        c, s = math.cos(self.psi), math.sin(self.psi)
        return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])

    def _mounted(self, p: Array) -> Point:
        c, s = math.cos(self.mount.yaw), math.sin(self.mount.yaw)
        return self.mount.s_x + c * p[0] - s * p[1], self.mount.s_y + s * p[0] + c * p[1], float(p[2])

    @property
    def hand(self) -> Point:
        return self._mounted(self.p)

    @property
    def points(self) -> tuple[Point, ...]:
        return tuple(self._mounted(place) for place in self.places)

    @property
    def manipulability(self) -> float:
        return math.sqrt(max(0.0, float(np.linalg.det(self.J @ self.J.T))))

    def towards_manipulability(self) -> tuple[float, ...]:
        slopes = []
        for k in range(len(self.joints)):
            ends = []
            for step in (1e-5, -1e-5):
                moved = tuple(angle + step * (j == k) for j, angle in enumerate(self.joints))
                ends.append(self.arm.at(moved, self.mount).manipulability)
            slopes.append((ends[0] - ends[1]) / 2e-5)
        return tuple(slopes)

    def jacobian(self) -> tuple[tuple[float, ...], ...]:
        rows = np.vstack((self.polar @ self.J[:3], self.polar @ self.J[3:]))
        rows[1] /= self.l
        return tuple(tuple(float(slope) for slope in row) for row in rows)

    def moved(self, rates: tuple[float, ...]) -> Moved:
        v_m, w_m, v_z, w_r, w_t, w_z = (np.array(self.jacobian()) @ np.array(rates)).tolist()
        return v_m, w_m, v_z, w_r, w_t, w_z

    def rates(self, v_m: float, w_m: float, rest: Rest, dt: float) -> tuple[tuple[float, ...], Verdict]:
        v_z, *turning = rest
        w = self.polar.T @ np.array(turning)
        x = np.concatenate((self.polar.T @ np.array([v_m, self.l * w_m, v_z]), w))
        dq = self.solved(x)
        if dt > 0.0 and self.arm.whole and np.any(x):
            l, psi = self.l + v_m * dt, self.psi + w_m * dt
            goal = np.array([l * math.cos(psi), l * math.sin(psi), self.p[2] + v_z * dt])
            R = turned(w * dt) @ self.R
            for _ in range(4):
                end = self.arm.at(tuple(np.array(self.joints) + dq * dt), self.mount)
                dq = dq + end.solved(np.concatenate((goal - end.p, vector(R @ end.R.T)))) / dt
        return tuple(float(rate) for rate in dq), Verdict.MOVING


class SerialRobot(Record, frozen=True):
    """A base with a serial arm."""

    arm: Any
    name: str = "serial"
    summary: str = "an arm in space, for tests"
    mount: Mount = Mount(0.1, 0.0, 0.0)
    base: Base = Base(0.6, 2.0, 3.5, 12.0, (0.5, 0.4))
    workspace: Workspace = Workspace(0.45, 0.85, -0.6, 0.6)
    start: Start = Start(0.65, 0.0)
    gripper: bool = True
    command: Limits = Limits()
    bands: tuple[float, float, float] = (0.1, 0.1, 0.1)

    def placed(self, mount: Mount, workspace: Workspace) -> SerialRobot:
        return msgspec.structs.replace(self, mount=mount, workspace=workspace)


X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
SHOULDER, ELBOW, WRIST = (0.0, 0.0, 0.5), (0.5, 0.0, 0.5), (1.0, 0.0, 0.5)
HAND = (1.1, 0.0, 0.5)


def six(whole: bool = True) -> SerialArm:
    """Return an arm of six joints: yaw, pitch, pitch, and a wrist that rolls, pitches and yaws."""
    return SerialArm(
        [Z, Y, Y, X, Y, Z],
        [SHOULDER, SHOULDER, ELBOW, WRIST, WRIST, WRIST],
        HAND,
        (0.0, -1.0, 1.8, 0.0, -0.8, 0.0),
        whole,
    )


def seven(whole: bool = True) -> SerialArm:
    """Return the same with a roll of the upper arm: one joint more than is needed."""
    return SerialArm(
        [Z, Y, X, Y, X, Y, Z],
        [SHOULDER, SHOULDER, SHOULDER, ELBOW, WRIST, WRIST, WRIST],
        HAND,
        (0.0, -1.0, 0.1, 1.8, 0.0, -0.8, 0.0),
        whole,
    )
