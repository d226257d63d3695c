"""The step of `step` once more, with numpy and MuJoCo's kinematics: where there is no compiler. Equal to it to 1e-9.

Small arrays are slow in numpy: what is a few floats stays floats, and one product does for several.
"""

from __future__ import annotations

import math
from typing import final

import numpy as np

from overreach.arm.spatial import task
from overreach.arm.spatial.inverse import SLIGHT, damping_beside
from overreach.arm.spatial.lean_fit import Fit
from overreach.arm.spatial.lean_kinematics import Kinematics
from overreach.arm.spatial.room import ENDLESS, NEAR_HOME, NULL_SPEED, OFF_LIMITS, SPEED, WEIGHT
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.step import (
    APPROACH,
    ASKED,
    AT_BOUND,
    AT_LIMIT,
    AT_SPEED,
    ATTEMPTS,
    CHANGING,
    COS,
    DELTA,
    DT,
    ELL,
    EPS,
    FINE,
    HELD,
    K_R,
    MARGIN,
    NOT_WHOLE,
    NULL_GAIN,
    OFF,
    PLAN,
    R_HOME,
    S_X,
    S_Y,
    SIN,
    SLIGHTLY,
    SLIP,
    SMALL_TURN,
    STEP,
    STUCK,
    TOL_V,
    TOL_W,
    W_C,
    WAS,
    D,
    U,
    half_turn,
    reach_for,
)

Three = tuple[float, float, float]


@final
class Lean:
    """`forward` and `step` for one arm."""

    def __init__(self, screws: Array, tip: Array, limits: Array, setup: Array) -> None:
        kinematics = Kinematics(screws, tip)
        self.forward, self._pose = kinematics.forward, kinematics.pose
        self._n = screws.shape[0]
        self._setup = setup.tolist()
        self._held = int(setup[HELD])
        self._m = task.count(self._held)
        self._w = limits[:, WEIGHT].copy()
        self._speed = limits[:, SPEED].tolist()
        self._most_null = (NULL_SPEED * limits[:, SPEED]).tolist()
        self._joints = [_joint(row, setup[MARGIN], setup[NULL_GAIN]) for row in limits.tolist()]
        self._R_home = setup[R_HOME : R_HOME + 9].reshape(3, 3)
        self._approach = setup[APPROACH : APPROACH + 3]
        self._lengths = np.array([1.0, 1.0, 1.0, setup[ELL], setup[ELL], setup[ELL]])[:, None]

    def _attitude(self, yaw: float) -> Array:
        c, s = math.cos(yaw), math.sin(yaw)
        R: Array = np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))) @ self._R_home
        return R

    def _task(self, bearing: float, R: Array) -> Array | None:
        """Return the rows of the turnings that are held, (m - 3, 3); None for all of them."""
        if self._held == task.WHOLE:
            return None
        T = np.empty((self._m, 6))
        task.rows(self._held, bearing, R.ravel(), self._approach, self._setup[ELL], T)
        return T[3:, 3:]

    def _rows(self, T: Array | None, J: Array) -> Array:
        if T is None:
            return np.asarray(J * self._lengths)
        return np.concatenate((J[:3], T @ J[3:]))

    def _asks(self, T: Array | None, v: Three, turning: Three) -> Array:
        """Return the task of a velocity and a turning."""
        if T is None:
            ell = self._setup[ELL]
            return np.array((*v, ell * turning[0], ell * turning[1], ell * turning[2]))
        return np.concatenate((v, T @ turning))

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
        R = self._attitude(bearing + f)
        e_x, e_y, e_z = _apart(R, hand)
        k_r = setup[K_R]
        e = (e_x * k_r, e_y * k_r, e_z * k_r)
        T = self._task(bearing, R)
        A = self._rows(T, J)
        rates = ask[ASKED:]
        low, high, null, change = _room(self._joints, q.tolist(), dt)
        soft_low = [max(one, before - most) for one, before, most in zip(low, rates, change, strict=True)]
        soft_high = [min(one, before + most) for one, before, most in zip(high, rates, change, strict=True)]
        fit = Fit(A, self._w, null, self._most_null, low, high, soft_low, soft_high, setup[EPS])

        def left_by(v_x: float, v_y: float, w: float, e: Three) -> Array:
            v_x, v_y = v_x - w * y_h, v_y + w * x_h
            rate = (c * v_y - s_ * v_x) / l
            return self._asks(T, (-v_x, -v_y, 0.0), (e[0], e[1], e[2] - inside * w - (1.0 - inside) * rate))

        was_base, step_base = ask[WAS : WAS + 3], ask[STEP : STEP + 3]
        slip = _moved(ask, *ask[SLIP : SLIP + 3])
        scale, joint, why, off_v, off_w = 0.0, -1, FINE, 0.0, 0.0
        hand_1, J_1, places = np.empty(12), np.empty((6, n)), np.empty((n, 3))
        for attempt in range(ATTEMPTS):
            part = 0.0 if attempt == ATTEMPTS - 1 else 0.5**attempt
            u_x, u_y, u_z = [part * one for one in ask[U : U + 3]]
            w_c = part * ask[W_C]
            plan = [part * one for one in ask[PLAN : PLAN + 3]]
            base = [reach_for(*one) for one in zip(plan, was_base, step_base, strict=True)]
            real = _plus(_moved(ask, *base), slip)
            rate = inside * w_c + (1.0 - inside) * (c * u_y - s_ * u_x) / l
            x = self._asks(T, (u_x, u_y, u_z), (0.0, 0.0, rate))
            scale, joint, dq = fit.fit(x, left_by(*real, e))
            if scale < 1.0:
                x_b = x + left_by(*_moved(ask, *plan), (0.0, 0.0, 0.0))
                scale, joint, dq = fit.fit(x_b, left_by(*slip, e))
                s_base = max(scale, 0.0)
                wanted = [s_base * one for one in plan]
                base = [reach_for(*one) for one in zip(wanted, was_base, step_base, strict=True)]
                real = _plus(_moved(ask, *base), slip)
                if base != wanted:
                    again, other, dq = fit.fit(s_base * x, left_by(*real, e))
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
            if fraction < 1.0:
                why = CHANGING
                dq = [before + fraction * (one - before) for one, before in zip(dq, rates, strict=True)]
                dq = _within(dq, low, high, rates, change)
                base = [before + fraction * (one - before) for one, before in zip(base, was_base, strict=True)]
                real = _plus(_moved(ask, *base), slip)
            place = _goal((x_h, y_h, z_h), (scale * u_x, scale * u_y, scale * u_z), real, dt)
            bearing_1 = math.atan2(place[1], place[0])
            f_1 = 0.0
            if setup[D] > 0.0:
                turned_by = half_turn(bearing_1 - bearing) + (real[2] - scale * w_c) * dt
                f_1, _ = task.yielding(half_turn(ask[DELTA] - turned_by), setup[D])
            R_1 = self._attitude(bearing_1 + f_1)
            T_1 = self._task(bearing_1, R_1)
            now = np.array(dq)
            self.forward(q + now * dt, hand_1, J_1, places)
            missing, size = self._missing(T_1, place, R_1, hand_1)
            if why != CHANGING:
                if size > SMALL_TURN * setup[ELL]:
                    missing[3:] = 0.0
                w = self._w
                free = [a + AT_BOUND < one < b - AT_BOUND for one, a, b in zip(dq, low, high, strict=True)]
                if m <= sum(free) < n:
                    w = w * np.array(free, float)
                A_1 = self._rows(T_1, J_1)
                A_w = A_1 * w
                G = A_w @ A_1.T
                G.flat[:: m + 1] += damping_beside(fit.sigma, setup[EPS]) + SLIGHT * float(G.trace())
                now = now + A_w.T @ np.linalg.solve(G, missing) / dt
                dq = _within(now.tolist(), low, high, rates, change)
                self._pose(q + np.array(dq) * dt, hand_1)
                missing, size = self._missing(T_1, place, R_1, hand_1)
            off_v = math.sqrt(missing[0] ** 2 + missing[1] ** 2 + missing[2] ** 2) / dt
            off_w = size / setup[ELL]
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
        out[n:] = (*base, scale, fit.sigma, joint, why, off_v, off_w, f)

    def _missing(self, T: Array | None, place: Three, R: Array, hand: Array) -> tuple[Array, float]:
        e_x, e_y, e_z = _apart(R, hand)
        x, y, z = hand[9:].tolist()
        missing = self._asks(T, (place[0] - x, place[1] - y, place[2] - z), (e_x, e_y, e_z))
        return missing, math.hypot(*missing[3:].tolist())


def _joint(limits: list[float], margin: float, gain: float) -> tuple[float, ...]:
    """Return what `_room` needs of one joint."""
    lower, upper, speed, braking, change, home, weight = limits
    half = 0.5 * (upper - lower)
    endless = half > ENDLESS
    half = 1.0 if endless else half
    return (
        lower + margin, upper - margin, speed, braking, change, home, 0.5 * (lower + upper), half,
        0.0 if endless else OFF_LIMITS, -gain * weight,
    )  # fmt: skip


def _room(
    joints: list[tuple[float, ...]], q: list[float], dt: float
) -> tuple[list[float], list[float], list[float], list[float]]:
    """Return low and high of `room.bounds`, the null rates of `room.downhill`, and greatest changes."""
    lows, highs, nulls, changes = [], [], [], []
    square = dt * dt
    for (first, last, speed, braking, change, home, middle, half, off, pull), x in zip(joints, q, strict=True):
        ahead, behind = last - x, x - first
        stops = braking * (math.sqrt(square + 2.0 * ahead / braking) - dt) if ahead > 0.0 else 0.0
        highs.append(stops if stops < speed else speed)
        stops = braking * (math.sqrt(square + 2.0 * behind / braking) - dt) if behind > 0.0 else 0.0
        lows.append(-stops if stops < speed else -speed)
        y = (x - middle) / half
        y2 = y * y
        nulls.append(pull * (NEAR_HOME * (x - home) / half + off * y2 * y2 * y2 * y) / half)
        changes.append(change * dt)
    return lows, highs, nulls, changes


def _within(
    rates: list[float], low: list[float], high: list[float], was: list[float], change: list[float]
) -> list[float]:
    """Return rates held to their bounds, then to how much they can change."""
    return [
        max(before - most, min(before + most, max(a, min(b, one))))
        for one, a, b, before, most in zip(rates, low, high, was, change, strict=True)
    ]


def _moved(ask: list[float], v_x: float, v_y: float, w: float) -> Three:
    """See `step.moved_with`."""
    v_x, v_y = v_x - w * ask[S_Y], v_y + w * ask[S_X]
    return ask[COS] * v_x + ask[SIN] * v_y, ask[COS] * v_y - ask[SIN] * v_x, w


def _plus(one: Three, other: Three) -> Three:
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]


def _apart(goal: Array, hand: Array) -> Three:
    """See `turning.apart`."""
    (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = (goal @ hand[:9].reshape(3, 3).T).tolist()
    x, y, z = r21 - r12, r02 - r20, r10 - r01
    sine = 0.5 * math.sqrt(x * x + y * y + z * z)
    angle = math.atan2(sine, 0.5 * (r00 + r11 + r22 - 1.0))
    factor = 0.5 if sine < 1e-9 else 0.5 * angle / sine
    return factor * x, factor * y, factor * z


def _goal(hand: Three, move: Three, base: Three, dt: float) -> Three:
    """See `step.goal`; `move`: s u."""
    turn = base[2] * dt
    half = 0.5 * turn
    chord = dt * (1.0 - half * half / 6.0 if abs(half) < 1e-4 else math.sin(half) / half)
    c_h, s_h, c, s = math.cos(half), math.sin(half), math.cos(turn), math.sin(turn)
    x = hand[0] + move[0] * dt - chord * (base[0] * c_h - base[1] * s_h)
    y = hand[1] + move[1] * dt - chord * (base[0] * s_h + base[1] * c_h)
    return c * x + s * y, c * y - s * x, hand[2] + move[2] * dt
