"""An arm of any joints in space: `overreach.arm.chain.Arm`, and its own step, which chooses among joint motions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from overreach.arm.chain import Asked, Moved, Point, Rest, Step
from overreach.arm.mount import Mount
from overreach.arm.polar import wrap
from overreach.arm.spatial import step as layout
from overreach.arm.spatial.attitude import tool_axes, turned, vector
from overreach.arm.spatial.engine import Engine, engine
from overreach.arm.spatial.manner import Manner
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.settle import Posture
from overreach.arm.spatial.task import PITCH, SPIN, WHOLE, wanted, yielding
from overreach.types import Channel
from overreach.verdicts import Verdict

NEWTON = 4
"""Steps of Newton's method that end a period where it should."""
BRAKING = 0.5
"""A joint brakes before its limit with this part of its greatest acceleration."""
H = 1e-6
"""Step [rad, m] of the differences that give the manipulability's slope."""
NO_TURN = (0.0, 0.0, 0.0)


class SpatialArm:
    """Joints as screws in the arm's frame, their limits, a home posture, and the manner in which the hand is held.

    screws, tip: as in `screws`; compiled: whether to use the compiler; None: if there is one.
    """

    def __init__(
        self,
        channels: tuple[Channel, ...],
        screws: Array,
        tip: Array,
        home: tuple[float, ...],
        manner: Manner,
        compiled: bool | None = None,
    ) -> None:
        self.channels, self.screws, self.tip, self.home, self.manner = channels, screws, tip, home, manner
        self._compiled = compiled
        self.limits: Array = np.array(
            [
                (one.lower, one.upper, one.rate_max, BRAKING * one.change_max, one.change_max, at, one.rate_max**2)
                for one, at in zip(channels, home, strict=True)
            ]
        )
        self.posture_at_home = Posture(screws, tip, self.limits, manner)
        self.R_home = self.posture_at_home.R_home
        self.engine: Engine = engine(screws, tip, self.limits, manner.setup, compiled)
        self.tool = tool_axes(self.R_home, np.array(manner.approach))
        self.attitude = tuple(self.R_home.ravel().tolist())

    def __reduce__(self) -> tuple[type[SpatialArm], tuple[Any, ...]]:
        """Travel between processes as what it is made from: compiled code would be compiled anew."""
        return SpatialArm, (self.channels, self.screws, self.tip, self.home, self.manner, self._compiled)

    def held(self, manner: Manner) -> SpatialArm:
        """Return the same arm with its hand held in another manner."""
        return self.made(self.home, manner, self._compiled)

    def made(self, home: tuple[float, ...], manner: Manner, compiled: bool | None = None) -> SpatialArm:
        """Return the same arm with another home, its hand held in another manner."""
        return SpatialArm(self.channels, self.screws, self.tip, home, manner, compiled)

    governs = True
    aside = False

    @property
    def turns(self) -> bool:
        """Whether its hand's yaw stays in the world, however the base turns."""
        return self.manner.yaw > 0.0

    @property
    def whole(self) -> bool:
        """Whether it holds all turnings of its hand, so that it can turn it about any axis."""
        return self.manner.held == WHOLE

    @property
    def follows(self) -> frozenset[str]:
        """Parts of a twist beyond the plane that its step carries out: pitch and roll where it holds them."""
        held = self.manner.held
        return frozenset({"v_z", *(["w_y"] if held & PITCH else []), *(["w_x"] if held & SPIN else [])})

    @property
    def rows(self) -> tuple[int, ...]:
        """The place, and the turnings that it holds where they are about r, t or z."""
        return self.manner.rows

    @property
    def branch(self) -> tuple[tuple[float, float], ...]:
        """The joints' own limits: in the workspace the posture is a function of the place."""
        return tuple((one.lower, one.upper) for one in self.channels)

    @property
    def reach(self) -> tuple[float, float]:
        """Least and greatest l [m]."""
        return 0.0, self.manner.reach

    def at(self, joints: tuple[float, ...], mount: Mount) -> SpatialChain:
        """Return the arm at `joints` [rad, m], mounted at `mount`."""
        return SpatialChain(self, joints, mount)

    def posture(self, l: float, psi: float, z: float | None = None) -> tuple[float, ...]:
        """Return joints that put the hand at (l, psi) and height z [m], by default its home's, walked to from home."""
        return self.posture_at_home.walk(l, psi, z)


class SpatialChain:
    """The arm at its joints; see `overreach.arm.chain.Chain`."""

    __slots__ = ("J", "_arm", "_mount", "_q", "_turn", "joints", "l", "places", "pose", "psi")

    def __init__(self, arm: SpatialArm, joints: tuple[float, ...], mount: Mount) -> None:
        n = len(joints)
        self._arm, self._mount, self.joints = arm, mount, joints
        self._q = q = np.array(joints)
        self.pose, self.J, self.places = np.empty(12), np.empty((6, n)), np.empty((n, 3))
        arm.engine.forward(q, self.pose, self.J, self.places)
        x, y = float(self.pose[9]), float(self.pose[10])
        self.l = math.hypot(x, y)
        self.psi = math.atan2(y, x)
        self._turn = (1.0, 0.0) if mount.yaw == 0.0 else (math.cos(mount.yaw), math.sin(mount.yaw))

    def _mounted(self, x: float, y: float, z: float) -> Point:
        mount, (c, s) = self._mount, self._turn
        return mount.s_x + c * x - s * y, mount.s_y + s * x + c * y, z

    @property
    def hand(self) -> Point:
        """The hand (x, y, z) [m] in the base frame."""
        return self._mounted(*self.pose[9:].tolist())

    @property
    def points(self) -> tuple[Point, ...]:
        """From the ground under the shoulder through the joints' places to the hand."""
        places = self.places.tolist()
        return self._mounted(0.0, 0.0, 0.0), *[self._mounted(*place) for place in places], self.hand

    @property
    def attitude(self) -> Array:
        """The hand's attitude in the base frame, (3, 3)."""
        c, s = self._turn
        return np.asarray(np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))) @ self.pose[:9].reshape(3, 3))

    @property
    def facing(self) -> float:
        """Ahead is outward."""
        return 0.0

    def heading(self, attitude: tuple[float, ...] | None = None) -> float:
        """Return how far [rad] the heading that the hand holds is past its bearing: that which its yaw comes from.

        attitude: the one that is held at bearing 0, by default home's.
        """
        R_0 = self._arm.R_home if attitude is None else np.array(attitude).reshape(3, 3)
        M = self.pose[:9].reshape(3, 3) @ R_0.T
        yaw = wrap(math.atan2(M[1, 0] - M[0, 1], M[0, 0] + M[1, 1]) - self.psi)
        return wanted(yaw, self._arm.manner.yaw)

    def turning(
        self,
        w_c: float,
        w_b: float,
        joints: tuple[float, ...],
        turn: tuple[float, float, float] = NO_TURN,
        attitude: tuple[float, ...] | None = None,
    ) -> tuple[float, float, float]:
        """Return how fast [rad/s] the hand is to turn, along the base's axes.

        It yaws as its bearing does or, where its yaw is fixed, by w_c; and with its attitude, as in `Asked`.
        """
        inside = 0.0
        if self._arm.manner.yaw > 0.0:
            _, inside = yielding(self.heading(attitude), self._arm.manner.yaw)
        x, y, z, spin = self._turning(turn)
        c, s = self._turn
        w = np.array((c * x - s * y, s * x + c * y, z)) + spin * self.attitude @ self._arm.manner.approach
        yaw = inside * w_c + (1.0 - inside) * (w_b + self.moved(joints)[1])
        return float(w[0]), float(w[1]), float(w[2]) + yaw

    @property
    def manipulability(self) -> float:
        """sqrt(det(A A^T)), A the Jacobian's rows that the arm has."""
        A = np.array(self.jacobian())[list(self._arm.rows)]
        return math.sqrt(max(0.0, float(np.linalg.det(A @ A.T))))

    def towards_manipulability(self) -> tuple[float, ...]:
        """Return the gradient of the manipulability, by differences."""
        slopes = []
        for k in range(len(self.joints)):
            ends = []
            for h in (H, -H):
                joints = list(self.joints)
                joints[k] += h
                ends.append(self._arm.at(tuple(joints), self._mount).manipulability)
            slopes.append((ends[0] - ends[1]) / (2.0 * H))
        return tuple(slopes)

    def _polar(self) -> Array:
        c, s = math.cos(self.psi), math.sin(self.psi)
        return np.array(((c, s, 0.0), (-s, c, 0.0), (0.0, 0.0, 1.0)))

    def jacobian(self) -> tuple[tuple[float, ...], ...]:
        """Return the rows of l, psi, z and the rotations about r, t, z."""
        polar = self._polar()
        rows = np.concatenate((polar @ self.J[:3], polar @ self.J[3:]))
        rows[1] /= self.l
        return tuple(map(tuple, rows.tolist()))

    def moved(self, rates: tuple[float, ...]) -> Moved:
        """Return what the hand does at joint rates `rates`."""
        v_x, v_y, v_z, w_x, w_y, w_z = (self.J @ rates).tolist()
        c, s = math.cos(self.psi), math.sin(self.psi)
        return c * v_x + s * v_y, (c * v_y - s * v_x) / self.l, v_z, c * w_x + s * w_y, c * w_y - s * w_x, w_z

    def rates(self, v_m: float, w_m: float, rest: Rest, dt: float) -> tuple[tuple[float, ...], Verdict]:
        """Return the joint rates, weighted by the joints' speeds, with which a period ends where it should.

        Limits are not looked at: `step` does.
        """
        arm = self._arm
        rows = list(arm.rows)
        asked = np.array((v_m, w_m, *rest))[rows]
        lengths = np.array((1.0, self.l, 1.0, *(arm.manner.ell,) * 3))[rows, None]
        w = arm.limits[:, -1]

        def solved(chain: SpatialChain, x: Array) -> Array:
            A = np.array(chain.jacobian())[rows] * lengths
            A_w = A * w
            G = A_w @ A.T
            G.flat[:: len(rows) + 1] += SLIGHT * G.trace()
            return np.asarray(A_w.T @ np.linalg.solve(G, x * lengths[:, 0]))

        dq = solved(self, asked)
        if dt > 0.0 and np.any(asked):
            l, psi, z = self.l + v_m * dt, self.psi + w_m * dt, float(self.pose[11]) + rest[0] * dt
            turn = np.array(rest[1:]) @ self._polar() * dt
            R = turned(turn) @ self.pose[:9].reshape(3, 3)
            for _ in range(NEWTON):
                end = arm.at(tuple((self._q + dq * dt).tolist()), self._mount)
                left = end._polar() @ vector(R @ end.pose[:9].reshape(3, 3).T)
                off = np.array((l - end.l, wrap(psi - end.psi), z - float(end.pose[11]), *left.tolist()))[rows]
                dq = dq + solved(end, off) / dt
        return tuple(dq.tolist()), Verdict.MOVING

    def step(self, asked: Asked) -> Step:
        """Return the arm's step: see `overreach.arm.spatial.step`."""
        arm, mount, n = self._arm, self._mount, len(self.joints)
        c, s = self.pose[9] / self.l, self.pose[10] / self.l
        u_r, u_t, u_z = asked.u
        numbers = np.array(
            (
                c * u_r - s * u_t, s * u_r + c * u_t, u_z, asked.w_c, asked.delta,
                *asked.plan, *asked.slip, *asked.was, *asked.change, asked.dt, mount.s_x, mount.s_y, *self._turn,
                *(asked.attitude or arm.attitude), *self._turning(asked.turn), *asked.joints,
            )
        )  # fmt: skip
        out = np.empty(n + layout.DONE)
        arm.engine.step(self._q, self.pose, self.J, numbers, out)
        *joints, v_x, v_y, w_z, scale, _sigma, joint, why, _off_v, _off_w, _yaw = out[: n + layout.HOLDS].tolist()
        held = asked.attitude if asked.turn == NO_TURN else tuple(out[n + layout.HOLDS :].tolist())
        verdict, said = SAYS[int(why)]
        name = arm.channels[int(joint)].moves if joint >= 0.0 else "A joint"
        return Step(tuple(joints), (v_x, v_y, w_z), scale, verdict, said.format(name), held)

    def _turning(self, turn: tuple[float, float, float]) -> tuple[float, float, float, float]:
        """Return a turning as a step is asked for it: along the arm's axes, and about the approach axis."""
        if turn == NO_TURN:
            return 0.0, 0.0, 0.0, 0.0
        w_r, w_t, w_z = turn
        c, s = float(self.pose[9]) / self.l, float(self.pose[10]) / self.l
        if self._arm.whole:
            return c * w_r - s * w_t, s * w_r + c * w_t, w_z, 0.0
        return -s * w_t, c * w_t, 0.0, w_r

    @property
    def tool(self) -> Array:
        """The hand's own axes, forward, left and up, in polar axes: the columns of (3, 3)."""
        return np.asarray(self._polar() @ self.pose[:9].reshape(3, 3) @ self._arm.tool)


SAYS: dict[int, tuple[Verdict, str]] = {
    layout.FINE: (Verdict.MOVING, ""),
    layout.AT_LIMIT: (Verdict.JOINT_LIMIT, "{} is near its limit."),
    layout.AT_SPEED: (Verdict.SPEED, "{} is at its greatest speed."),
    layout.CHANGING: (Verdict.ACCELERATION, ""),
    layout.STUCK: (Verdict.JOINT_LIMIT, "{} is at its limit, and no other can take its part."),
    layout.OFF: (Verdict.OFF, ""),
}
"""Why a step is less than was asked -> the verdict, and its reason with the joint's name."""
SLIGHT = 1e-14
"""Damping of `rates`, as a part of the trace: of no weight but where the arm is singular."""
