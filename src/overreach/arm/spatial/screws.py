"""Forward kinematics of a chain of screws: axes and anchors at zero, in the arm's frame. Scalar: to be compiled.

The arm's frame: z = 0 on the ground, origin under the shoulder, x ahead of the arm; it is fixed to the base.
A row of `screws` is one joint, from the base out: axis (3), anchor (3), 1 for a slide or 0 for a hinge. `tip` is the
hand at zero: its rotation by rows (9), its place (3). `hand` likewise, at the joints q. J: rows v_x, v_y, v_z, w_x,
w_y, w_z of the hand, along the arm's axes. `places`: where each joint is.
"""

from __future__ import annotations

import math
from typing import Any

from numpy.typing import NDArray

Array = NDArray[Any]
"""An array of float64."""


def forward(screws: Array, tip: Array, q: Array, hand: Array, J: Array, places: Array) -> None:
    """Write the hand's pose, its Jacobian and the joints' places at `q` [rad, m] into (12,), (6, n) and (n, 3)."""
    n = q.shape[0]
    r00, r01, r02, r10, r11, r12, r20, r21, r22 = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    x, y, z = 0.0, 0.0, 0.0
    for i in range(n):
        a, b, c = screws[i, 0], screws[i, 1], screws[i, 2]
        u, v, w = screws[i, 3], screws[i, 4], screws[i, 5]
        # The joint's axis and anchor, moved by the joints before it.
        axis_x = r00 * a + r01 * b + r02 * c
        axis_y = r10 * a + r11 * b + r12 * c
        axis_z = r20 * a + r21 * b + r22 * c
        J[3, i], J[4, i], J[5, i] = axis_x, axis_y, axis_z
        at_x = r00 * u + r01 * v + r02 * w + x
        at_y = r10 * u + r11 * v + r12 * w + y
        at_z = r20 * u + r21 * v + r22 * w + z
        places[i, 0], places[i, 1], places[i, 2] = at_x, at_y, at_z
        if screws[i, 6] != 0.0:
            x += axis_x * q[i]
            y += axis_y * q[i]
            z += axis_z * q[i]
            continue
        cos, sin = math.cos(q[i]), math.sin(q[i])
        o = 1.0 - cos
        m00, m01, m02 = a * a * o + cos, a * b * o - c * sin, a * c * o + b * sin
        m10, m11, m12 = b * a * o + c * sin, b * b * o + cos, b * c * o - a * sin
        m20, m21, m22 = c * a * o - b * sin, c * b * o + a * sin, c * c * o + cos
        r00, r01, r02 = (
            r00 * m00 + r01 * m10 + r02 * m20,
            r00 * m01 + r01 * m11 + r02 * m21,
            r00 * m02 + r01 * m12 + r02 * m22,
        )
        r10, r11, r12 = (
            r10 * m00 + r11 * m10 + r12 * m20,
            r10 * m01 + r11 * m11 + r12 * m21,
            r10 * m02 + r11 * m12 + r12 * m22,
        )
        r20, r21, r22 = (
            r20 * m00 + r21 * m10 + r22 * m20,
            r20 * m01 + r21 * m11 + r22 * m21,
            r20 * m02 + r21 * m12 + r22 * m22,
        )
        x = at_x - (r00 * u + r01 * v + r02 * w)
        y = at_y - (r10 * u + r11 * v + r12 * w)
        z = at_z - (r20 * u + r21 * v + r22 * w)
    for k in range(3):
        t0, t1, t2 = tip[k], tip[3 + k], tip[6 + k]
        hand[k] = r00 * t0 + r01 * t1 + r02 * t2
        hand[3 + k] = r10 * t0 + r11 * t1 + r12 * t2
        hand[6 + k] = r20 * t0 + r21 * t1 + r22 * t2
    x += r00 * tip[9] + r01 * tip[10] + r02 * tip[11]
    y += r10 * tip[9] + r11 * tip[10] + r12 * tip[11]
    z += r20 * tip[9] + r21 * tip[10] + r22 * tip[11]
    hand[9], hand[10], hand[11] = x, y, z
    for i in range(n):
        a, b, c = J[3, i], J[4, i], J[5, i]
        if screws[i, 6] != 0.0:
            J[0, i], J[1, i], J[2, i] = a, b, c
            J[3, i], J[4, i], J[5, i] = 0.0, 0.0, 0.0
        else:
            u, v, w = x - places[i, 0], y - places[i, 1], z - places[i, 2]
            J[0, i], J[1, i], J[2, i] = b * w - c * v, c * u - a * w, a * v - b * u
