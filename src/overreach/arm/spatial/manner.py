"""How a hand is held while its arm moves it, and what follows from the arm's size."""

from __future__ import annotations

import numpy as np

from overreach.arm.spatial import step, task
from overreach.arm.spatial.screws import Array
from overreach.types import Record

ELL = 0.28
"""Length [m/rad] at which a turning counts as a motion, in parts of the arm's reach R."""
DAMPED = 0.4
"""Damping begins below this part of the least singular value that the workspace has."""
NULL_GAIN = 4.0
"""The posture is drawn to its own with this gain [1/s]."""
K_R = 10.0
"""An error of the attitude fades at this rate [1/s]."""
MARGIN = 0.02
"""Joints stay so far [rad, m] from their limits."""
TOL_V, TOL_W = 0.0011, 0.01
"""A step is as asked where its error is at most this: in parts of R a second, and in rad ..."""
MOST_V = 1e-3
"""... and, however long the arm is, in m/s."""


class Manner(Record, frozen=True):
    """How the hand is held.

    reach: R [m], the greatest horizontal distance of the hand from the shoulder; sigma: least singular value [m/s] that
    the workspace has; held: the turnings that are held (`task.PITCH`, `SPIN`, `THIRD`); yaw: greatest deviation D [rad]
    of a yaw that is fixed in the world from the bearing, 0 where the hand follows its bearing; approach: the axis that
    points ahead, in the hand's frame; aside: whether the arm cannot move its hand about the shoulder.
    """

    reach: float
    sigma: float
    held: int = task.WHOLE
    yaw: float = 0.0
    approach: tuple[float, float, float] = (0.0, 0.0, 1.0)
    aside: bool = False

    @property
    def ell(self) -> float:
        """Length [m/rad] at which a turning counts as a motion."""
        return ELL * self.reach

    @property
    def eps(self) -> float:
        """Singular value [m/s] below which the inverse is damped."""
        return DAMPED * self.sigma

    @property
    def rows(self) -> tuple[int, ...]:
        """The rows of `overreach.arm.chain.Arm.rows` that can be chosen freely."""
        place = (0, 2) if self.aside else (0, 1, 2)
        if self.held == task.WHOLE:
            return (*place, 3, 4, 5)
        return (*place, 4) if self.held & task.PITCH else place

    @property
    def setup(self) -> Array:
        """What `step` takes."""
        setup = np.empty(step.SETUP)
        setup[: step.APPROACH] = (
            self.held, self.ell, self.eps, NULL_GAIN, K_R, MARGIN, self.yaw, min(TOL_V * self.reach, MOST_V), TOL_W,
        )  # fmt: skip
        setup[step.APPROACH :] = self.approach
        return setup
