"""Who computes the kinematics and the step of one arm: compiled code where there is a compiler, else numpy."""

from __future__ import annotations

import subprocess
import sys
from functools import cache
from typing import Any, Protocol, final

import numpy as np

from overreach.arm.spatial.asked import ASKED, ATTITUDE, COS, DT, TURN
from overreach.arm.spatial.lean import Lean
from overreach.arm.spatial.room import CHANNEL, HOME
from overreach.arm.spatial.screws import Array, forward
from overreach.arm.spatial.step import DONE, HELD, SETUP, step
from overreach.compiled import available, compile_all, is_ready, ready


class Engine(Protocol):
    """The kinematics and the step of one arm."""

    def forward(self, q: Array, hand: Array, J: Array, places: Array) -> None:
        """See `screws.forward`."""
        ...

    def step(self, q: Array, hand: Array, J: Array, asked: Array, out: Array) -> None:
        """See `step.step`."""
        ...


FUNCTIONS = (forward, step)


@cache
def _functions() -> Any:
    return compile_all(FUNCTIONS)


@final
class Compiled:
    """The scalar code, compiled. It has been run once when this returns: its first call takes long."""

    def __init__(self, screws: Array, tip: Array, limits: Array, setup: Array) -> None:
        self._forward, self._step = _functions()
        self._chain, self._fixed = (screws, tip), (screws, limits, np.concatenate((setup, tip)))
        n = len(screws)
        q, hand, J, places = limits[:, HOME].copy(), np.empty(12), np.empty((6, n)), np.empty((n, 3))
        self.forward(q, hand, J, places)
        asked = np.zeros(ASKED + n)
        asked[DT], asked[COS] = 0.01, 1.0
        asked[ATTITUDE:TURN] = np.eye(3).ravel()
        self.step(q, hand, J, asked, np.empty(n + DONE))

    def forward(self, q: Array, hand: Array, J: Array, places: Array) -> None:
        """See `screws.forward`."""
        self._forward(*self._chain, q, hand, J, places)

    def step(self, q: Array, hand: Array, J: Array, asked: Array, out: Array) -> None:
        """See `step.step`."""
        self._step(*self._fixed, q, hand, J, asked, out)


def engine(screws: Array, tip: Array, limits: Array, setup: Array, compiled: bool | None = None) -> Engine:
    """Return the compiled engine if `compiled`, by default where it can be had in a moment; else the one with numpy."""
    if ready(FUNCTIONS) if compiled is None else compiled:
        return Compiled(screws, tip, limits, setup)
    return Lean(screws, tip, limits, setup)


def warm() -> bool:
    """Compile the engine, where there is a compiler and it is not done yet: takes seconds; say whether it is there."""
    if not available():
        return False
    if not ready(FUNCTIONS):
        n = 3
        screws, tip, limits = np.zeros((n, 7)), np.zeros(12), np.zeros((n, CHANNEL))
        screws[:, 2], screws[:, 3], tip[:9], tip[9] = 1.0, 0.1, np.eye(3).ravel(), 0.5
        limits[:] = (-1.0, 1.0, 1.0, 1.0, 2.0, 0.0, 1.0)
        setup = np.ones(SETUP)
        setup[HELD] = 0.0
        Compiled(screws, tip, limits, setup)
        is_ready(FUNCTIONS)
    return True


def warm_beside() -> None:
    """Begin to compile the engine in a process of its own, of the least priority, for the next start."""
    if available() and not ready(FUNCTIONS):
        subprocess.Popen(
            [sys.executable, "-m", "overreach.arm.spatial"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True,
        )  # fmt: skip
