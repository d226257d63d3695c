"""Attitudes as matrices (3, 3): by rotation vectors, and the axes of a hand."""

from __future__ import annotations

import math

import numpy as np

from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.turning import apart, rotation

UPRIGHT = 0.9
"""A hand points up or down where its approach axis has this share of up."""


def turned(w: Array) -> Array:
    """Return the rotation by the vector `w` [rad]."""
    R = np.empty(9)
    rotation(float(w[0]), float(w[1]), float(w[2]), R)
    return R.reshape(3, 3)


def vector(R: Array) -> Array:
    """Return the rotation vector [rad] of R: its logarithm."""
    w = np.empty(3)
    apart(R.ravel(), np.eye(3).ravel(), w)
    return w


def tool_axes(R_home: Array, approach: Array) -> Array:
    """Return forward, left and up of a hand in its own frame, (3, 3): forward is where it points; up is up at home.

    Where the hand points up or down at home, the top of what it sees is what is ahead of it, or behind it.
    """
    up = R_home.T[:, 2]
    along = float(up @ approach)
    if abs(along) > UPRIGHT:
        up = -math.copysign(1.0, along) * R_home.T[:, 0]
        along = float(up @ approach)
    up = up - along * approach
    up = up / np.linalg.norm(up)
    return np.stack((approach, np.cross(up, approach), up), axis=1)
