"""The full planar step for many robots at once: vector code in each thread, and the threads side by side."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray

from overreach.errors import SetupError
from overreach.fast.robot import fixed_step
from overreach.law.blend import Blend, Smoothstep
from overreach.model.planar import PlanarRobot, planar

Array = NDArray[np.float64]
Batch = Callable[[Array, Array], None]

IN, OUT = 6, 4
"""Rows in: theta_1, theta_2, theta_b, theta_e, v_c, w_c; rows out: v_b, w_b, dtheta_1, dtheta_2."""
FEW = 500
"""Below this many robots one thread is faster than waking the others (measured: `overreach bench`)."""


def compile_batch(robot: PlanarRobot | None = None, blend: Blend | None = None, few: int = FEW) -> Batch:
    """Return step(states, rates): (6, n) float64 in, (4, n) float64 out, written in place; nothing is allocated.

    A column is a robot; rows as in `compile_step`. Raises SetupError for arrays of another shape or type.
    """
    fixed = fixed_step(robot or planar(), blend or Smoothstep())

    def all_of_them(states: Array, rates: Array) -> None:
        for k in prange(states.shape[1]):  # where it is not compiled for threads, prange is range
            rates[0, k], rates[1, k], rates[2, k], rates[3, k] = fixed(
                states[0, k], states[1, k], states[2, k], states[3, k], states[4, k], states[5, k]
            )

    signature = ["void(float64[:, ::1], float64[:, ::1])"]
    one: Any = njit(signature, error_model="numpy", fastmath={"contract"})(all_of_them)
    many: Any = njit(signature, error_model="numpy", fastmath={"contract"}, parallel=True)(all_of_them)

    def step(states: Array, rates: Array) -> None:
        n = _checked(states, rates)
        if not states.flags.writeable:  # the compiled code is for arrays that can be written to; it does not write here
            states = states.copy()
        (one if n < few else many)(states, rates)

    return step


def _checked(states: Array, rates: Array) -> int:
    """Return the number of robots; raise SetupError unless the arrays can be used as they are."""
    for name, array, rows in (("states", states, IN), ("rates", rates, OUT)):
        fits = type(array) is np.ndarray and array.ndim == 2 and array.shape[0] == rows
        if not (fits and array.dtype == np.float64 and array.flags.c_contiguous):
            found = f"{array.shape} {array.dtype}" if isinstance(array, np.ndarray) else type(array).__name__
            raise SetupError(f"{name} must be a C-contiguous float64 array of shape ({rows}, n), got {found}")
    if not rates.flags.writeable:
        raise SetupError("rates must be an array that can be written to")
    if np.may_share_memory(states, rates):
        raise SetupError("states and rates must not share memory: what is written would be read again")
    if states.shape[1] != rates.shape[1]:
        raise SetupError(f"states are of {states.shape[1]} robots, rates of {rates.shape[1]}: they must be as many")
    return int(states.shape[1])
