"""The Protocol of a robot: what the loop needs from a driver or a simulation."""

from __future__ import annotations

from typing import Protocol

from overreach.errors import told
from overreach.model.model import Model
from overreach.types import BaseTwist, RobotState


class RobotFault(Exception):  # noqa: N818  # a fault is what it is: the loop goes on
    """What is wrong with a robot, in a sentence for the operator."""


def sentence(did: str, error: BaseException) -> str:
    """Return, as a sentence, that a robot could not be `did` (read, written to, armed), and why."""
    return str(error) if isinstance(error, RobotFault) else f"The robot could not be {did}: {told(error)}."


class Robot(Protocol):
    """A base and an arm that take velocities. `now` [s] is the caller's monotonic clock."""

    @property
    def model(self) -> Model:
        """The robot's description."""
        ...

    @property
    def simulated(self) -> bool:
        """Whether nothing real moves, so that it may be put back to its start."""
        ...

    def read(self, now: float) -> RobotState:
        """Return the state at `now`, with the present motion of the base. May raise: that is a fault."""
        ...

    def write(
        self, base: BaseTwist, joints: tuple[float, ...], gripper: float | None, now: float, deadline: float
    ) -> None:
        """Ask for a base twist [m/s, rad/s], joint rates [rad/s, m/s] and a gripper's opening, 0 to 1 (None: it stays).

        They hold until the next call, which comes by `deadline` [s] if all is well; past it, a robot that can come to
        rest by itself does so. May raise: that is a fault.
        """
        ...

    def arm(self, now: float) -> None:
        """Get ready to move: an operator has armed. Called before anything moves. May raise: that is a fault."""
        ...

    def stop(self, now: float) -> None:
        """Stand still: hold zero velocity. Called at the end of every run, on every path."""
        ...

    def restart(self, now: float) -> None:
        """Go back to the start, at rest. Called only for a simulated robot."""
        ...


class Handed(Protocol):
    """What a robot with several hands has beside that."""

    def choose(self, hand: str) -> None:
        """Take the gripper that is written and reported for that of `hand`; the others stay as they are."""
        ...
