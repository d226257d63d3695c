"""What a step is asked, and what a base twist does to the arm's frame and leaves to the arm. Scalar: to be compiled."""

from __future__ import annotations

import math

from overreach.arm.spatial.screws import Array

U, W_C, DELTA, PLAN, SLIP, WAS, STEP, DT, S_X, S_Y, COS, SIN = 0, 3, 4, 5, 8, 11, 14, 17, 18, 19, 20, 21
ATTITUDE, TURN, SPIN, ASKED = 22, 31, 34, 35
"""What is asked, in `asked`: u [m/s] along the arm's axes (3), w_c [rad/s], the wanted yaw past the bearing [rad], the
base's plan, slip, last written twist and greatest change (3 each: v_x, v_y, w_z, along the base's axes), the period
[s]; shoulder [m] and cosine and sine of the arm's yaw in the base frame; the attitude that is held at bearing 0, by
rows (9), how it is to turn [rad/s]: along the arm's axes (3), and about the approach axis; behind them the joint rates
that were written last (n)."""


def reach_for(wanted: float, was: float, step: float) -> float:
    """Return what a base rate becomes in one period."""
    return max(was - step, min(was + step, wanted))


def moved_with(asked: Array, base: Array, out: Array) -> None:
    """Write the twist of the arm's frame, along its own axes, that a base twist gives it into `out` (3,)."""
    v_x, v_y = base[0] - base[2] * asked[S_Y], base[1] + base[2] * asked[S_X]
    out[0], out[1], out[2] = asked[COS] * v_x + asked[SIN] * v_y, asked[COS] * v_y - asked[SIN] * v_x, base[2]


def happens(asked: Array, base: Array, slip: Array, out: Array) -> None:
    """Write the twist that the arm's frame really has, for what is written to the base and its slip."""
    moved_with(asked, base, out)
    for i in range(3):
        out[i] += slip[i]


def task_of(T: Array, v_x: float, v_y: float, v_z: float, yaw: float, out: Array) -> None:
    """Write T (v_x, v_y, v_z, 0, 0, yaw) into `out`."""
    for i in range(T.shape[0]):
        out[i] = T[i, 0] * v_x + T[i, 1] * v_y + T[i, 2] * v_z + T[i, 5] * yaw


def is_turned(asked: Array) -> bool:
    """Say whether the attitude is to turn."""
    return bool(asked[TURN] != 0.0 or asked[TURN + 1] != 0.0 or asked[TURN + 2] != 0.0 or asked[SPIN] != 0.0)


def and_turning(T: Array, part: float, w: Array, out: Array) -> None:
    """Add part T (0, 0, 0, w) to `out`."""
    for i in range(3, T.shape[0]):
        out[i] += part * (T[i, 3] * w[0] + T[i, 4] * w[1] + T[i, 5] * w[2])


def left_by(T: Array, base: Array, hand: Array, polar: Array, inside: float, e: Array, out: Array) -> None:
    """Write into `out` the task that a base twist leaves to the arm, and with it the turning `e` [rad/s].

    polar: cosine and sine of the hand's bearing, and l. A hand that follows its bearing (inside = 0) turns with it; one
    whose yaw is held (inside = 1) turns back as the base turns.
    """
    v_x, v_y = base[0] - base[2] * hand[10], base[1] + base[2] * hand[9]
    bearing_rate = (polar[0] * v_y - polar[1] * v_x) / polar[2]
    task_of(T, -v_x, -v_y, 0.0, -inside * base[2] - (1.0 - inside) * bearing_rate, out)
    for i in range(3, T.shape[0]):
        out[i] += T[i, 3] * e[0] + T[i, 4] * e[1] + T[i, 5] * e[2]


def goal(hand: Array, u: Array, scale: float, base: Array, dt: float, out: Array) -> None:
    """Write where s u takes the hand in `dt` [s], seen from where the base twist has then taken the base (3,) [m]."""
    turn = base[2] * dt
    half = 0.5 * turn
    chord = dt * (1.0 - half * half / 6.0 if abs(half) < 1e-4 else math.sin(half) / half)
    c_h, s_h, c, s = math.cos(half), math.sin(half), math.cos(turn), math.sin(turn)
    x = hand[9] + scale * u[0] * dt - chord * (base[0] * c_h - base[1] * s_h)
    y = hand[10] + scale * u[1] * dt - chord * (base[0] * s_h + base[1] * c_h)
    out[0], out[1], out[2] = c * x + s * y, c * y - s * x, hand[11] + scale * u[2] * dt
