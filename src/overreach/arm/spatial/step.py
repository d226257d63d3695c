"""One period of an arm in space on a base that takes its part: rates, what they achieve, and what limits them.

Scalar: to be compiled. Its twin with numpy is `lean.Lean`; both follow one specification, to 1e-9:

    f         the hand's yaw past its bearing that is wanted; R = Rz(bearing + f) R_0 is the reference attitude, R_0
              the one that is held: home's at first, and then as it was turned
    base      what really happens: the plan, held to what its acceleration allows, and its slip
    x         s u, less what the base carries, plus K_R log(R R_hand^T): s is one scale for the whole command
    rates     `fit`; where s < 1, the base is scaled as well and the arm solved again
    q_1       q + rates dt; the base moves on its exact arc; the pose still missing there is made up for by the same
              inverse, or by one over the joints that are not at a bound (a chord-Newton step)
    verdict   of the forward kinematics at the end: where the hand is not where s u takes it, smaller s are tried,
              and the attitude is left as it is

A step is exact in the hand's place, at the end of its period, whatever the joints' curvature.
"""

from __future__ import annotations

import math

import numpy as np

from overreach.arm.spatial.asked import (
    ASKED,
    ATTITUDE,
    DELTA,
    DT,
    PLAN,
    SLIP,
    SPIN,
    STEP,
    TURN,
    W_C,
    WAS,
    U,
    and_turning,
    goal,
    happens,
    is_turned,
    left_by,
    moved_with,
    reach_for,
    task_of,
)
from overreach.arm.spatial.fit import fit
from overreach.arm.spatial.inverse import damping_beside, inverse_beside, rates
from overreach.arm.spatial.room import CHANGE, NULL_SPEED, SPEED, WEIGHT, bounds, downhill
from overreach.arm.spatial.screws import Array, forward
from overreach.arm.spatial.task import FOLDED, count, held_part, product, rows, yielding
from overreach.arm.spatial.turning import apart, turned_on, yawed

HELD, ELL, EPS, NULL_GAIN, K_R, MARGIN, D, TOL_V, TOL_W = range(9)
APPROACH, SETUP = 9, 12
"""What is fixed for an arm and its orientation mode, in `setup`: the turnings that are held, length ell [m], eps [m/s],
gains [1/s], margin [rad, m], the greatest deviation D of a fixed yaw [rad] (0: the bearing is followed), tolerances
[m/s, rad]; then the approach axis in the hand's frame (3); behind them, for `step`, the tip (12): see `screws`."""

BASE, SCALE, SIGMA, JOINT, WHY, OFF_V, OFF_W, YAW, HOLDS, DONE = 0, 3, 4, 5, 6, 7, 8, 9, 10, 19
"""What is answered, in `out`, behind the n joint rates: the base twist to write (3), scale, sigma [m/s], the joint that
limits (-1: none), why, error at the period's end [m/s], of the attitude [rad], f [rad], and the attitude that is held
at bearing 0 from then on, by rows (9)."""
FINE, AT_LIMIT, AT_SPEED, CHANGING, STUCK, OFF = range(6)
"""Why a command is scaled: a joint's limit, a joint's speed, its acceleration, nothing fits, the hand would be off."""

TURN_BACK = 0.3
"""An error of the attitude fades at most so fast [rad/s]: a hand that begins far from it turns slowly, in its place."""
SMALL_TURN = 2e-3
"""An attitude's error [rad] up to which it is made up for within one period; a greater one fades at K_R."""
AT_BOUND = 1e-9
SLIGHTLY = 1e-9
"""A change of rates beyond its limit by this part is rounding, and cut off."""
NOT_WHOLE = 0.999
"""The scale that is told where the hand's place is kept and its attitude is not."""
ONE_TURNING = 4
"""Rows of a task of the place and one turning."""
ATTEMPTS = 4
"""Scales that are tried where a step misses: s, s/2, s/4, 0."""


def missing(T: Array, ell: float, place: Array, R: Array, hand: Array, e: Array, out: Array) -> float:
    """Write the task from a hand to a place and an attitude into `out`; return the length of its turning part [rad]."""
    angle = apart(R, hand, e)
    size = 0.0
    for i in range(T.shape[0]):
        if i < 3:
            out[i] = place[i] - hand[9 + i]
        else:
            out[i] = T[i, 3] * e[0] + T[i, 4] * e[1] + T[i, 5] * e[2]
            size += out[i] * out[i]
    return angle if T.shape[0] == ONE_TURNING and angle > FOLDED else math.sqrt(size) / ell


def short_of(A: Array, dq: Array, part: float, x: Array, x_c: Array) -> float:
    """Return by how much [m/s] rates miss the hand's velocity in `part` x + x_c."""
    square = 0.0
    for i in range(3):
        off = part * x[i] + x_c[i]
        for k in range(A.shape[1]):
            off -= A[i, k] * dq[k]
        square += off * off
    return math.sqrt(square)


def half_turn(angle: float) -> float:
    """Return `angle` [rad] less a whole turn where it is beyond half a turn."""
    if angle > math.pi:
        return angle - 2.0 * math.pi
    return angle + 2.0 * math.pi if angle < -math.pi else angle


def step(
    screws: Array, limits: Array, setup: Array, q: Array, hand: Array, J: Array, asked: Array, out: Array
) -> None:  # fmt: skip
    """Write the step of an arm at joints `q` (n,), with `hand` and `J` from `forward`, into `out` (n + DONE,).

    See SETUP, `asked.ASKED` and BASE for what is in the others. Always finite.
    """
    n = q.shape[0]
    held, dt = int(setup[HELD]), asked[DT]
    m = count(held)
    # A few blocks rather than many small ones: asking for memory is a third of the cost of all this.
    of_task, of_joints = np.empty((2, m, 6)), np.empty((11, n))
    of_rows, of_space, poses = np.empty((2, m)), np.empty((11, 3)), np.empty((4, 12))
    A, B, J_1, places = np.empty((m, n)), np.empty((m, m)), np.empty((6, n)), np.empty((n, 3))
    T, T_1, x, x_c = of_task[0], of_task[1], of_rows[0], of_rows[1]
    low, high, soft_low, soft_high = of_joints[0], of_joints[1], of_joints[2], of_joints[3]
    null, most_null, dq, q_1, more = of_joints[4], of_joints[5], of_joints[6], of_joints[7], of_joints[8]
    free, w = of_joints[9], of_joints[10]
    e, place, none, base, real = of_space[0], of_space[1], of_space[2], of_space[3], of_space[4]
    plan, slip, u, polar, off = of_space[5], of_space[6], of_space[7], of_space[8], of_space[9]
    turning, hand_1, R, R_1, E = of_space[10], poses[0], poses[1, :9], poses[2, :9], poses[3, :9]
    none[:] = 0.0
    R_0, approach, tip = asked[ATTITUDE:TURN], setup[APPROACH:SETUP], setup[SETUP:]
    was = asked[ASKED:]
    ell, eps = setup[ELL], setup[EPS]
    moved_with(asked, asked[SLIP : SLIP + 3], slip)

    r_x, r_y = hand[9], hand[10]
    polar[2] = max(math.sqrt(r_x * r_x + r_y * r_y), 1e-9)
    polar[0], polar[1] = r_x / polar[2], r_y / polar[2]
    bearing = math.atan2(r_y, r_x)
    f, inside = 0.0, 0.0
    if setup[D] > 0.0:
        f, inside = yielding(asked[DELTA], setup[D])
    yawed(R_0, bearing + f, R)
    turns = is_turned(asked)
    if turns:
        for i in range(3):
            a_i = R[3 * i] * approach[0] + R[3 * i + 1] * approach[1] + R[3 * i + 2] * approach[2]
            turning[i] = asked[TURN + i] + asked[SPIN] * a_i
    apart(R, hand, e)
    rows(held, bearing, R, approach, ell, T)
    k_r = min(setup[K_R], TURN_BACK / max(held_part(T, ell, e), 1e-9))
    product(T, J, A)
    for k in range(n):
        w[k], most_null[k] = limits[k, WEIGHT], NULL_SPEED * limits[k, SPEED]
    for i in range(3):
        e[i] *= k_r
    bounds(limits, q, dt, setup[MARGIN], low, high)
    for k in range(n):  # the posture is not to be drawn home faster than joints can change their rates
        soft_low[k] = max(low[k], was[k] - limits[k, CHANGE] * dt)
        soft_high[k] = min(high[k], was[k] + limits[k, CHANGE] * dt)
    downhill(limits, q, setup[NULL_GAIN], null)

    s, sigma, joint, why, off_v, off_w = 0.0, 0.0, -1, FINE, 0.0, 0.0
    for attempt in range(ATTEMPTS):
        part = 0.0 if attempt == ATTEMPTS - 1 else 0.5**attempt
        if attempt == 1:
            e[:] = 0.0
        w_c = part * asked[W_C]
        for i in range(3):
            u[i], plan[i] = part * asked[U + i], part * asked[PLAN + i]
            # At scale 1: the base does what it can, and the arm makes up for it.
            base[i] = reach_for(plan[i], asked[WAS + i], asked[STEP + i])
        happens(asked, base, slip, real)
        bearing_rate = (polar[0] * u[1] - polar[1] * u[0]) / polar[2]
        task_of(T, u[0], u[1], u[2], inside * w_c + (1.0 - inside) * bearing_rate, x)
        if turns:
            and_turning(T, part, turning, x)
        left_by(T, real, hand, polar, inside, e, x_c)
        s, sigma, joint = fit(A, w, x, x_c, null, most_null, low, high, soft_low, soft_high, eps, B, dq)
        part_of_x = s
        if s < 1.0:
            # The whole command is scaled, base included: what the base carries then scales with it.
            moved_with(asked, plan, real)
            left_by(T, real, hand, polar, inside, none, x_c)
            for i in range(m):
                x[i] += x_c[i]
            left_by(T, slip, hand, polar, inside, e, x_c)
            s, sigma, joint = fit(A, w, x, x_c, null, most_null, low, high, soft_low, soft_high, eps, B, dq)
            s_base, part_of_x = max(s, 0.0), s
            kept = True
            for i in range(3):
                base[i] = reach_for(s_base * plan[i], asked[WAS + i], asked[STEP + i])
                kept = kept and base[i] == s_base * plan[i]
            happens(asked, base, slip, real)
            if not kept:  # it cannot change so fast: the arm makes up for what it does
                task_of(
                    T, s_base * u[0], s_base * u[1], s_base * u[2],
                    s_base * (inside * w_c + (1.0 - inside) * bearing_rate), x,
                )  # fmt: skip
                if turns:
                    and_turning(T, s_base * part, turning, x)
                left_by(T, real, hand, polar, inside, e, x_c)
                again, sigma, other = fit(A, w, x, x_c, null, most_null, low, high, soft_low, soft_high, eps, B, dq)
                part_of_x = again
                if again < 1.0:
                    joint = other
                    s = s_base * again if again >= 0.0 else -1.0
        why = FINE
        if s < 0.0:
            s, why = 0.0, STUCK
        elif s < 1.0 and joint >= 0:
            why = AT_SPEED if abs(dq[joint]) >= 0.999 * limits[joint, SPEED] else AT_LIMIT
        fraction = 1.0
        for k in range(n):
            change = abs(dq[k] - was[k])
            if change > limits[k, CHANGE] * dt * (1.0 + SLIGHTLY):
                fraction = min(fraction, limits[k, CHANGE] * dt / change)
        astray = fraction < 1.0 and (part_of_x < 0.0 or short_of(A, dq, part_of_x, x, x_c) > setup[TOL_V])
        if astray and attempt < ATTEMPTS - 1:
            continue  # part of the way to rates that do not move the hand as they should leads anywhere
        if fraction < 1.0:  # all channels go the same part of their way
            why = CHANGING
            for k in range(n):
                dq[k] = max(low[k], min(high[k], was[k] + fraction * (dq[k] - was[k])))
                dq[k] = reach_for(dq[k], was[k], limits[k, CHANGE] * dt)
            for i in range(3):
                base[i] = asked[WAS + i] + fraction * (base[i] - asked[WAS + i])
            happens(asked, base, slip, real)

        goal(hand, u, s, real, dt, place)
        bearing_1 = math.atan2(place[1], place[0])
        f_1 = 0.0
        if setup[D] > 0.0:
            turned_by = half_turn(bearing_1 - bearing) + (real[2] - s * w_c) * dt
            f_1, _ = yielding(half_turn(asked[DELTA] - turned_by), setup[D])
        if turns:
            turned_on(R_0, bearing + f, asked[TURN:SPIN], asked[SPIN], approach, s * part * dt, E, R_1)
            yawed(R_1, bearing_1 + f_1, R)
        else:
            yawed(R_0, bearing_1 + f_1, R)
        rows(held, bearing_1, R, approach, ell, T_1)
        for k in range(n):
            q_1[k] = q[k] + dq[k] * dt
        forward(screws, tip, q_1, hand_1, J_1, places)
        size = missing(T_1, ell, place, R, hand_1, off, x)
        if why != CHANGING:
            if size > SMALL_TURN:
                for i in range(3, m):
                    x[i] = 0.0
            many = 0
            for k in range(n):
                free[k] = 1.0 if low[k] + AT_BOUND < dq[k] < high[k] - AT_BOUND else 0.0
                many += int(free[k])
            if m <= many < n:
                inverse_beside(A, w, free, damping_beside(sigma, eps), B)
            else:
                free[:] = 1.0
            rates(A, w, free, B, x, more)
            for k in range(n):
                dq[k] = max(low[k], min(high[k], dq[k] + more[k] / dt))
                dq[k] = reach_for(dq[k], was[k], limits[k, CHANGE] * dt)
                q_1[k] = q[k] + dq[k] * dt
            forward(screws, tip, q_1, hand_1, J_1, places)
            size = missing(T_1, ell, place, R, hand_1, off, x)
        off_v = math.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) / dt
        off_w = size
        s *= part
        if why == CHANGING:
            s *= fraction
            break
        if attempt > 0:
            why = OFF
        if off_v <= setup[TOL_V]:
            break
    for k in range(n):
        out[k] = dq[k]
    for i in range(3):
        out[n + BASE + i] = base[i]
    if s >= 1.0 and off_w > setup[TOL_W]:
        why = OFF
        s = NOT_WHOLE
    out[n + SCALE], out[n + SIGMA], out[n + JOINT], out[n + WHY] = s, sigma, joint, why
    out[n + OFF_V], out[n + OFF_W], out[n + YAW] = off_v, off_w, f
    if turns:
        turned_on(R_0, bearing + f, asked[TURN:SPIN], asked[SPIN], approach, s * dt, E, R_1)
    for i in range(9):
        out[n + HOLDS + i] = R_1[i] if turns else R_0[i]
