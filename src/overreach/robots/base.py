"""What moves: the Protocol that a robot's driver or simulation answers to."""

from __future__ import annotations

from typing import Protocol

from overreach.types import BaseTwist, RobotState


class Robot(Protocol):
    """A base and an arm that take velocities. `now` [s] is the caller's monotonic clock."""

    def read(self, now: float) -> RobotState:
        """Return the state at `now`, the base twist that is happening included."""
        ...

    def write(self, twist: BaseTwist, dtheta: tuple[float, ...], now: float) -> None:
        """Ask for a base twist [m/s, rad/s] and joint rates [rad/s], to be held until the next call."""
        ...

    def stop(self, now: float) -> None:
        """Stand still: zero velocity, held. Called at the end of every run, in every path."""
        ...
