"""Postures as a function of the hand's place: walked to from home, and drawn to rest in the null space. Many at once.

    q += J# e + N (-GAIN w grad H) until at rest;   J# weighted by the squares of the joints' speeds, turnings times ell

H is the potential that draws the posture while driving as well (`room.downhill`): so that the posture found here is the
one that the arm will have there.
"""

from __future__ import annotations

import math
from typing import NamedTuple, final

import numpy as np

from overreach.arm.spatial import task
from overreach.arm.spatial.inverse import DAMPED
from overreach.arm.spatial.manner import Manner
from overreach.arm.spatial.room import ENDLESS, HOME, LOWER, NEAR_HOME, OFF_LIMITS, UPPER, WEIGHT
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.turning import STRAIGHT, apart

GAIN = 0.25
LONGEST = 0.15
"""Greatest move [rad, m] of a joint towards rest in one iteration."""
STRIDE = 0.5
"""Greatest move [rad, m] of a joint towards the place in one iteration: less, and far places are missed."""
ROOM = 0.03
"""Postures keep so far [rad, m] from the joints' limits."""
AT_BOUND = 1e-6
WALK, REST = 3, 25
"""Iterations on the way to a place, and at most there."""
CLOSE, AT_REST = 1e-5, 2e-3
"""At a place: this close [parts of R], with the joints moving less than this [rad, m] in an iteration."""
STRIDE_L, STRIDE_PSI, STRIDE_Z = 0.028, 0.1, 0.056
"""Lengths of a stride: l and z in parts of R, psi in rad."""


class Places(NamedTuple):
    """Where hands are to be: l [m], psi [rad], z [m], and the yaw [rad] past the bearing, one of each per posture."""

    l: Array
    psi: Array
    z: Array
    yaw: Array


class Settled(NamedTuple):
    """Postures (B, n), how far off the task they are [m], their least singular values [m/s], joints at limits aside."""

    q: Array
    off: Array
    sigma: Array


@final
class Posture:
    """The postures of one arm whose hand is held in one manner, with the attitude that it has at home, or another."""

    def __init__(self, screws: Array, tip: Array, limits: Array, manner: Manner, R_home: Array | None = None) -> None:
        self._screws, self._tip, self._limits, self.manner = screws, tip, limits, manner
        self._w = limits[:, WEIGHT]
        self._low, self._high = limits[:, LOWER] + ROOM, limits[:, UPPER] - ROOM
        half = 0.5 * (limits[:, UPPER] - limits[:, LOWER])
        self._endless = half > ENDLESS
        self._half = np.where(self._endless, 1.0, half)
        self._mid = 0.5 * (limits[:, UPPER] + limits[:, LOWER])
        self.home = limits[:, HOME].copy()
        R, p, _ = self.forward(self.home[None])
        self.l, self.psi, self.z = math.hypot(p[0, 0], p[0, 1]), math.atan2(p[0, 1], p[0, 0]), float(p[0, 2])
        own = _yaw(np.array([-self.psi]))[0] @ R[0]
        self.R_home: Array = np.ascontiguousarray(own if R_home is None else R_home)

    def forward(self, q: Array) -> tuple[Array, Array, Array]:
        """Return R (B, 3, 3), p (B, 3) and J (B, 6, n) of the hand at postures `q` (B, n)."""
        many, n = q.shape
        R = np.broadcast_to(np.eye(3), (many, 3, 3))
        p = np.zeros((many, 3))
        axes, places = np.empty((many, n, 3)), np.empty((many, n, 3))
        for k in range(n):
            axis, anchor = self._screws[k, :3], self._screws[k, 3:6]
            axes[:, k] = R @ axis
            places[:, k] = at = R @ anchor + p
            if self._screws[k, 6]:
                p = p + axes[:, k] * q[:, k, None]
                continue
            x, y, z = axis
            K = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
            sine, versine = np.sin(q[:, k])[:, None, None], (1.0 - np.cos(q[:, k]))[:, None, None]
            R = R @ (np.eye(3) + sine * K + versine * (K @ K))
            p = at - R @ anchor
        p = R @ self._tip[9:] + p
        J = np.empty((many, 6, n))
        slides = self._screws[:, 6] != 0.0
        J[:, :3] = np.where(slides, axes.transpose(0, 2, 1), np.cross(axes, p[:, None] - places).transpose(0, 2, 1))
        J[:, 3:] = np.where(slides, 0.0, axes.transpose(0, 2, 1))
        return R @ self._tip[:9].reshape(3, 3), p, J

    def _rows(self, psi: Array, R: Array) -> Array:
        """Return the task's rows (B, m, 6) at bearings `psi`, for hands that are to have the attitudes R (B, 3, 3)."""
        manner = self.manner
        m = task.count(manner.held)
        T = np.zeros((len(psi), m, 6))
        T[:, range(3), range(3)] = 1.0
        if manner.aside:  # what lies about the shoulder is not the arm's
            T[:, 0, 0], T[:, 0, 1] = np.cos(psi), np.sin(psi)
        if manner.held == task.WHOLE:
            T[:, range(3, 6), range(3, 6)] = manner.ell
            return np.delete(T, 1, axis=1) if manner.aside else T
        t = np.stack((-np.sin(psi), np.cos(psi), np.zeros_like(psi)), axis=1)
        a = R @ np.array(manner.approach)
        third = np.cross(a, t)
        third /= np.linalg.norm(third, axis=1, keepdims=True) + 1e-12
        k = 3
        for bit, axis in ((task.PITCH, t), (task.SPIN, a), (task.THIRD, third)):
            if manner.held & bit:
                T[:, k, 3:] = manner.ell * axis
                k += 1
        return np.delete(T, 1, axis=1) if manner.aside else T

    def task_jacobian(self, q: Array) -> Array:
        """Return the task's Jacobian (B, m, n) at postures `q`, as if each held the attitude that it has."""
        R, p, J = self.forward(q)
        return self._rows(np.arctan2(p[:, 1], p[:, 0]), R) @ J

    def settle(self, q: Array, begin: Places, end: Places, walk: int = WALK, rest: int = REST) -> Settled:
        """Return postures walked from `q` (B, n), which are at `begin`, to `end`, and drawn to rest there."""
        manner = self.manner
        q = q.copy()
        many = len(q)
        off, sigma = np.full(many, np.inf), np.zeros(many)
        busy = np.arange(many)
        for turn in range(walk + rest):
            part = min(1.0, (turn + 1) / max(1, walk))
            l, psi, z, yaw = (
                one[busy] + part * (other[busy] - one[busy]) for one, other in zip(begin, end, strict=True)
            )
            R_goal = _yaw(psi + yaw) @ self.R_home
            R, p, J = self.forward(q[busy])
            e = np.empty((len(busy), 6))
            e[:, 0], e[:, 1], e[:, 2] = l * np.cos(psi) - p[:, 0], l * np.sin(psi) - p[:, 1], z - p[:, 2]
            e[:, 3:] = _vector(R_goal @ R.transpose(0, 2, 1))
            T = self._rows(psi, R_goal)
            A, x = T @ J, (T @ e[:, :, None])[:, :, 0]
            off[busy] = np.abs(x).max(axis=1)
            A_w = A * self._w
            B, sigma[busy] = _inverses(A_w @ A.transpose(0, 2, 1), manner.eps)
            P = A_w.transpose(0, 2, 1) @ B
            null = -GAIN * self._w * self._slope(q[busy])
            null -= (P @ (A @ null[:, :, None]))[:, :, 0]
            moved = np.abs(null).max(axis=1)
            null *= np.minimum(1.0, LONGEST / (moved + 1e-12))[:, None]
            done = (off[busy] < CLOSE * manner.reach) & (moved < AT_REST) if turn >= walk else np.zeros(len(busy), bool)
            step = (P @ x[:, :, None])[:, :, 0]
            step *= np.minimum(1.0, STRIDE / (np.abs(step).max(axis=1) + 1e-12))[:, None]
            stepped = q[busy] + step + null
            stepped = np.minimum(self._high, np.maximum(self._low, stepped))
            q[busy] = np.where(done[:, None], q[busy], stepped)
            busy = busy[~done]
            if not len(busy):
                break
        held = (q <= self._low + AT_BOUND) | (q >= self._high - AT_BOUND)
        some = np.flatnonzero(held.any(axis=1))
        if len(some):
            sigma[some] = self._without(q[some], held[some], end.psi[some], end.yaw[some])
        return Settled(q, off, sigma)

    def _without(self, q: Array, held: Array, psi: Array, yaw: Array) -> Array:
        """Return the least singular values [m/s] of postures of which some joints are held at a limit."""
        _, _, J = self.forward(q)
        A = self._rows(psi, _yaw(psi + yaw) @ self.R_home) @ J
        values = np.linalg.eigvalsh((A * np.where(held, 0.0, self._w)[:, None, :]) @ A.transpose(0, 2, 1))
        return np.asarray(np.sqrt(np.maximum(values[:, 0], 0.0)))

    def _slope(self, q: Array) -> Array:
        """Return the gradient of the potential at postures `q`."""
        x = (q - self._mid) / self._half
        limits = np.where(self._endless, 0.0, OFF_LIMITS * x**7)
        return np.asarray((NEAR_HOME * (q - self.home) / self._half + limits) / self._half)

    def walk(self, l: float, psi: float, z: float | None = None) -> tuple[float, ...]:
        """Return the posture at a place, walked to from home in strides; z [m]: by default home's height."""
        z = self.z if z is None else z
        R = self.manner.reach
        apart = (abs(l - self.l) / (STRIDE_L * R), abs(psi - self.psi) / STRIDE_PSI, abs(z - self.z) / (STRIDE_Z * R))
        strides = max(1, math.ceil(max(apart)))
        q = self.home[None]
        if apart == (0.0, 0.0, 0.0):
            return tuple(self.home.tolist())
        for k in range(strides):
            begin, end = [
                _place(self.l + f * (l - self.l), self.psi + f * (psi - self.psi), self.z + f * (z - self.z))
                for f in (k / strides, (k + 1) / strides)
            ]
            q = self.settle(q, begin, end, rest=REST if k < strides - 1 else 8 * REST).q
        return tuple(q[0].tolist())


def _place(l: float, psi: float, z: float) -> Places:
    return Places(np.array([l]), np.array([psi]), np.array([z]), np.zeros(1))


def _yaw(angle: Array) -> Array:
    R = np.zeros((len(angle), 3, 3))
    R[:, 0, 0] = R[:, 1, 1] = np.cos(angle)
    R[:, 1, 0] = np.sin(angle)
    R[:, 0, 1] = -R[:, 1, 0]
    R[:, 2, 2] = 1.0
    return R


def _vector(M: Array) -> Array:
    """Return the rotation vectors (B, 3) [rad] of M (B, 3, 3)."""
    axis = np.stack((M[:, 2, 1] - M[:, 1, 2], M[:, 0, 2] - M[:, 2, 0], M[:, 1, 0] - M[:, 0, 1]), axis=1)
    sine = 0.5 * np.linalg.norm(axis, axis=1)
    trace = np.trace(M, axis1=1, axis2=2)
    angle = np.arctan2(sine, 0.5 * (trace - 1.0))
    found = np.asarray(axis * np.where(sine < 1e-9, 0.5, 0.5 * angle / np.maximum(sine, 1e-9))[:, None])
    for k in np.flatnonzero((sine < STRAIGHT) & (trace < 0.0)):
        apart(M[k].ravel(), np.eye(3).ravel(), found[k])
    return found


def _inverses(G: Array, eps: float) -> tuple[Array, Array]:
    """Return the damped inverses of G (B, m, m) and their least singular values (B,) [m/s]."""
    values, vectors = np.linalg.eigh(G)
    sigma = np.sqrt(np.maximum(values[:, 0], 0.0))
    damping = np.where(sigma < eps, DAMPED * eps * (1.0 - (sigma / eps) ** 2), 0.0) ** 2 + 1e-18
    inverse = (vectors / (values + damping[:, None])[:, None, :]) @ vectors.transpose(0, 2, 1)
    return inverse, sigma
