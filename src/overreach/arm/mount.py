"""Where the arm sits on the base."""

from __future__ import annotations

import math

from overreach.errors import WorkspaceError
from overreach.types import Record


class Mount(Record, frozen=True):
    """Where the arm sits on the base.

    s_x, s_y: the shoulder in the base frame [m] (the paper: 0); yaw: heading of the arm's x axis in
    the base frame [rad]. Raises WorkspaceError if a value is not finite.
    """

    s_x: float = 0.0
    s_y: float = 0.0
    yaw: float = 0.0

    def __post_init__(self) -> None:
        if not all(math.isfinite(value) for value in (self.s_x, self.s_y, self.yaw)):
            raise WorkspaceError(f"the arm's mount must be finite numbers, got {self}")

    @property
    def three(self) -> tuple[float, float, float]:
        """(s_x, s_y, yaw), as the functions of floats take it."""
        return self.s_x, self.s_y, self.yaw
