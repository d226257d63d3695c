"""What moves: the Protocol that a robot's driver or simulation answers to, and what the loop takes."""

from __future__ import annotations

from typing import Protocol

from overreach.model.model import Model
from overreach.types import BaseTwist, RobotState


class Robot(Protocol):
    """A base and an arm that take velocities. `now` [s] is the caller's monotonic clock."""

    @property
    def model(self) -> Model:
        """What it is."""
        ...

    @property
    def simulated(self) -> bool:
        """Whether nothing real moves: it may be put back to its start."""
        ...

    def read(self, now: float) -> RobotState:
        """Return the state at `now`, with the motion of the base that is happening. May raise: that is a fault."""
        ...

    def write(
        self, base: BaseTwist, joints: tuple[float, ...], gripper: float | None, now: float, deadline: float
    ) -> None:
        """Ask for a base twist [m/s, rad/s], joint rates [rad/s, m/s] and a gripper's opening, 0 to 1 (None: it stays).

        They hold until the next call, which comes by `deadline` [s] where all is well: a robot that can come to rest by
        itself does so after it. May raise: that is a fault.
        """
        ...

    def stop(self, now: float) -> None:
        """Stand still: zero velocity, held. Called at the end of every run, in every path."""
        ...

    def restart(self, now: float) -> None:
        """Go back to the start, at rest. Asked of a simulated robot alone."""
        ...
