"""The step of `step` once more, with numpy and MuJoCo's kinematics: where there is no compiler. Equal to it to 1e-9.

Small arrays are slow in numpy: what is a few floats stays floats, and one product does for several.
"""

from __future__ import annotations

import math
from operator import add
from typing import final

import numpy as np

from overreach.arm.spatial import task
from overreach.arm.spatial.asked import (
    ASKED,
    ATTITUDE,
    COS,
    DELTA,
    DT,
    PLAN,
    S_X,
    S_Y,
    SIN,
    SLIP,
    SPIN,
    STEP,
    TURN,
    W_C,
    WAS,
    U,
    is_turned,
    reach_for,
)
from overreach.arm.spatial.lean_fit import Fit, Floats
from overreach.arm.spatial.lean_kinematics import Kinematics
from overreach.arm.spatial.lean_room import joint_of, room, within
from overreach.arm.spatial.room import NULL_SPEED, SPEED, WEIGHT
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.step import (
    APPROACH,
    AT_BOUND,
    AT_LIMIT,
    AT_SPEED,
    ATTEMPTS,
    CHANGING,
    ELL,
    EPS,
    FINE,
    HELD,
    HOLDS,
    K_R,
    MARGIN,
    NOT_WHOLE,
    NULL_GAIN,
    OFF,
    ONE_TURNING,
    SLIGHTLY,
    SMALL_TURN,
    STUCK,
    TOL_V,
    TOL_W,
    TURN_BACK,
    D,
    half_turn,
)
from overreach.arm.spatial.turning import STRAIGHT, apart, turned_on, yawed

Three = tuple[float, float, float]


@final
class Lean:
    """`forward` and `step` for one arm."""

    def __init__(self, screws: Array, tip: Array, limits: Array, setup: Array) -> None:
        kinematics = Kinematics(screws, tip)
        self.forward, self._pose = kinematics.forward, kinematics.pose
        self._n = screws.shape[0]
        self._setup = setup.tolist()
        self._held, self._ell = int(setup[HELD]), float(setup[ELL])
        self._m = task.count(self._held)
        self._w = limits[:, WEIGHT].copy()
        self._speed = limits[:, SPEED].tolist()
        self._most_null = (NULL_SPEED * limits[:, SPEED]).tolist()
        self._joints = [joint_of(row, setup[MARGIN], setup[NULL_GAIN]) for row in limits.tolist()]
        self._approach = setup[APPROACH : APPROACH + 3]
        self._lengths = np.array([1.0, 1.0, 1.0, setup[ELL], setup[ELL], setup[ELL]])[:, None]

    def _task(self, bearing: float, R_0: Array, yaw: float) -> Array | None:
        """Return the rows of the turnings that are held, (m - 3, 3), for Rz(yaw) R_0; None for all of them."""
        if self._held == task.WHOLE:
            return None
        R, T = np.empty(9), np.empty((self._m, 6))
        yawed(R_0, yaw, R)
        task.rows(self._held, bearing, R, self._approach, self._ell, T)
        return T[3:, 3:]

    def _rows(self, T: Array | None, J: Array) -> Array:
        if T is None:
            return np.asarray(J * self._lengths)
        return np.concatenate((J[:3], T @ J[3:]))

    def _asks(self, T: Array | None, v: Three, turning: Three) -> Floats:
        """Return the task of a velocity and a turning."""
        if T is None:
            ell = self._ell
            return [*v, ell * turning[0], ell * turning[1], ell * turning[2]]
        return [*v, *(T @ turning).tolist()]

    def _apart(self, hand: Array, R_0: Array, yaw: float) -> tuple[float, Three]:
        """Return the angle and the rotation vector from a hand to Rz(yaw) R_0; see `turning.apart`."""
        M = R_0.reshape(3, 3) @ hand[:9].reshape(3, 3).T
        (m00, m01, m02), (m10, m11, m12), (m20, m21, m22) = M.tolist()
        c, s = math.cos(yaw), math.sin(yaw)
        x, y, z = m21 - s * m02 - c * m12, c * m02 - s * m12 - m20, s * m00 + c * m10 - c * m01 + s * m11
        sine = 0.5 * math.sqrt(x * x + y * y + z * z)
        trace = c * m00 - s * m10 + s * m01 + c * m11 + m22
        if sine < STRAIGHT and trace < 0.0:
            R, e = np.empty(9), np.empty(3)
            yawed(R_0, yaw, R)
            angle = apart(R, hand, e)
            return angle, (float(e[0]), float(e[1]), float(e[2]))
        angle = math.atan2(sine, 0.5 * (trace - 1.0))
        factor = 0.5 if sine < 1e-9 else 0.5 * angle / sine
        return angle, (factor * x, factor * y, factor * z)

    def _turned(self, R_0: Array, yaw: float, asked: Array, dt: float) -> Array:
        """See `turning.turned_on`."""
        out = np.empty(9)
        turned_on(R_0, yaw, asked[TURN:SPIN], asked[SPIN], self._approach, dt, np.empty(9), out)
        return out

    def _turning(self, R_0: Array, yaw: float, asked: Array) -> Three:
        """Return the turning that is asked for, along the arm's axes."""
        x, y, z, spin = asked[TURN:ASKED].tolist()
        if spin == 0.0:
            return x, y, z
        R = np.empty(9)
        yawed(R_0, yaw, R)
        a_x, a_y, a_z = (R.reshape(3, 3) @ self._approach).tolist()
        return x + spin * a_x, y + spin * a_y, z + spin * a_z

    def step(self, q: Array, hand: Array, J: Array, asked: Array, out: Array) -> None:
        """See `step.step`."""
        n, m, setup = self._n, self._m, self._setup
        ask = asked.tolist()
        dt = ask[DT]
        x_h, y_h, z_h = hand[9:].tolist()
        l = max(math.hypot(x_h, y_h), 1e-9)
        c, s_ = x_h / l, y_h / l
        bearing = math.atan2(y_h, x_h)
        f, inside = task.yielding(ask[DELTA], setup[D]) if setup[D] > 0.0 else (0.0, 0.0)
        R_0 = asked[ATTITUDE:TURN]
        T = self._task(bearing, R_0, bearing + f)
        angle, e = self._apart(hand, R_0, bearing + f)
        turns = is_turned(asked)
        w_x, w_y, w_z = self._turning(R_0, bearing + f, asked) if turns else (0.0, 0.0, 0.0)
        held = angle if T is None else math.hypot(*(T @ e).tolist()) / self._ell
        k_r = min(setup[K_R], TURN_BACK / max(held, 1e-9))
        e = (e[0] * k_r, e[1] * k_r, e[2] * k_r)
        A = self._rows(T, J)
        rates = ask[ASKED:]
        low, high, soft_low, soft_high, null, change = room(self._joints, q.tolist(), rates, dt)
        fit = Fit(A, self._w, null, self._most_null, low, high, soft_low, soft_high, setup[EPS])

        def left_by(v_x: float, v_y: float, w: float, e: Three) -> Floats:
            v_x, v_y = v_x - w * y_h, v_y + w * x_h
            rate = (c * v_y - s_ * v_x) / l
            return self._asks(T, (-v_x, -v_y, 0.0), (e[0], e[1], e[2] - inside * w - (1.0 - inside) * rate))

        was_base, step_base = ask[WAS : WAS + 3], ask[STEP : STEP + 3]
        slip = _moved(ask, *ask[SLIP : SLIP + 3])
        scale, joint, why, off_v, off_w = 0.0, -1, FINE, 0.0, 0.0
        hand_1 = np.empty(12)
        for attempt in range(ATTEMPTS):
            part = 0.0 if attempt == ATTEMPTS - 1 else 0.5**attempt
            if attempt == 1:
                e = (0.0, 0.0, 0.0)
            u_x, u_y, u_z = [part * one for one in ask[U : U + 3]]
            w_c = part * ask[W_C]
            plan = [part * one for one in ask[PLAN : PLAN + 3]]
            base = [reach_for(*one) for one in zip(plan, was_base, step_base, strict=True)]
            real = _plus(_moved(ask, *base), slip)
            rate = inside * w_c + (1.0 - inside) * (c * u_y - s_ * u_x) / l
            x = self._asks(T, (u_x, u_y, u_z), (part * w_x, part * w_y, part * w_z + rate))
            x_c = left_by(*real, e)
            scale, joint, dq = fit.fit(x, x_c)
            part_of_x, x_s = scale, x
            if scale < 1.0:
                x_s = list(map(add, x, left_by(*_moved(ask, *plan), (0.0, 0.0, 0.0))))
                x_c = left_by(*slip, e)
                scale, joint, dq = fit.fit(x_s, x_c)
                s_base, part_of_x = max(scale, 0.0), scale
                wanted = [s_base * one for one in plan]
                base = [reach_for(*one) for one in zip(wanted, was_base, step_base, strict=True)]
                real = _plus(_moved(ask, *base), slip)
                if base != wanted:
                    x_s, x_c = [s_base * one for one in x], left_by(*real, e)
                    again, other, dq = fit.fit(x_s, x_c)
                    part_of_x = again
                    if again < 1.0:
                        joint = other
                        scale = s_base * again if again >= 0.0 else -1.0
            why = FINE
            if scale < 0.0:
                scale, why = 0.0, STUCK
            elif scale < 1.0 and joint >= 0:
                why = AT_SPEED if abs(dq[joint]) >= 0.999 * self._speed[joint] else AT_LIMIT
            fraction = 1.0
            for one, before, most in zip(dq, rates, change, strict=True):
                if abs(one - before) > most * (1.0 + SLIGHTLY):
                    fraction = min(fraction, most / abs(one - before))
            if fraction < 1.0 and attempt < ATTEMPTS - 1:
                wanted_v = [part_of_x * one + more for one, more in zip(x_s[:3], x_c[:3], strict=True)]
                if part_of_x < 0.0 or math.dist((A[:3] @ dq).tolist(), wanted_v) > setup[TOL_V]:
                    continue  # part of the way to rates that do not move the hand as they should leads anywhere
            if fraction < 1.0:
                why = CHANGING
                dq = [before + fraction * (one - before) for one, before in zip(dq, rates, strict=True)]
                dq = within(dq, low, high, rates, change)
                base = [before + fraction * (one - before) for one, before in zip(base, was_base, strict=True)]
                real = _plus(_moved(ask, *base), slip)
            place = _goal((x_h, y_h, z_h), (scale * u_x, scale * u_y, scale * u_z), real, dt)
            bearing_1 = math.atan2(place[1], place[0])
            f_1 = 0.0
            if setup[D] > 0.0:
                turned_by = half_turn(bearing_1 - bearing) + (real[2] - scale * w_c) * dt
                f_1, _ = task.yielding(half_turn(ask[DELTA] - turned_by), setup[D])
            yaw_1 = bearing_1 + f_1
            R_1 = self._turned(R_0, bearing + f, asked, scale * part * dt) if turns else R_0
            T_1 = self._task(bearing_1, R_1, yaw_1)
            self._pose(q + np.array(dq) * dt, hand_1)
            missing, size = self._missing(T_1, place, R_1, yaw_1, hand_1)
            if why != CHANGING:
                if size > SMALL_TURN:
                    missing[3:] = [0.0] * (m - 3)
                free = [a + AT_BOUND < one < b - AT_BOUND for one, a, b in zip(dq, low, high, strict=True)]
                more = fit.more(missing, free if m <= sum(free) < n else None)
                dq = within([one + x / dt for one, x in zip(dq, more, strict=True)], low, high, rates, change)
                self._pose(q + np.array(dq) * dt, hand_1)
                missing, size = self._missing(T_1, place, R_1, yaw_1, hand_1)
            off_v = math.sqrt(missing[0] ** 2 + missing[1] ** 2 + missing[2] ** 2) / dt
            off_w = size
            scale *= part
            if why == CHANGING:
                scale *= fraction
                break
            if attempt > 0:
                why = OFF
            if off_v <= setup[TOL_V]:
                break
        if scale >= 1.0 and off_w > setup[TOL_W]:
            why, scale = OFF, NOT_WHOLE
        out[:n] = dq
        out[n : n + HOLDS] = (*base, scale, fit.sigma, joint, why, off_v, off_w, f)
        out[n + HOLDS :] = self._turned(R_0, bearing + f, asked, scale * dt) if turns else R_0

    def _missing(self, T: Array | None, place: Three, R_0: Array, yaw: float, hand: Array) -> tuple[Floats, float]:
        """See `step.missing`, for the attitude Rz(yaw) R_0."""
        x, y, z = hand[9:].tolist()
        angle, e = self._apart(hand, R_0, yaw)
        missing = self._asks(T, (place[0] - x, place[1] - y, place[2] - z), e)
        folded = self._m == ONE_TURNING and angle > task.FOLDED
        return missing, angle if folded else math.hypot(*missing[3:]) / self._ell


def _moved(ask: Floats, v_x: float, v_y: float, w: float) -> Three:
    """See `step.moved_with`."""
    v_x, v_y = v_x - w * ask[S_Y], v_y + w * ask[S_X]
    return ask[COS] * v_x + ask[SIN] * v_y, ask[COS] * v_y - ask[SIN] * v_x, w


def _plus(one: Three, other: Three) -> Three:
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]


def _goal(hand: Three, move: Three, base: Three, dt: float) -> Three:
    """See `step.goal`; `move`: s u."""
    turn = base[2] * dt
    half = 0.5 * turn
    chord = dt * (1.0 - half * half / 6.0 if abs(half) < 1e-4 else math.sin(half) / half)
    c_h, s_h, c, s = math.cos(half), math.sin(half), math.cos(turn), math.sin(turn)
    x = hand[0] + move[0] * dt - chord * (base[0] * c_h - base[1] * s_h)
    y = hand[1] + move[1] * dt - chord * (base[0] * s_h + base[1] * c_h)
    return c * x + s * y, c * y - s * x, hand[2] + move[2] * dt
