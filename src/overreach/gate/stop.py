"""The latches of the gate: stopped, faulted, armed, and the press of the dead-man that still counts.

    start -> DISARMED --arm--> ARMED --(release, press)--> MOVING
    any --stop--> STOPPED --reset--> DISARMED
    any --fail--> FAULT --reset--> DISARMED
    any --pause--> DISARMED

A press of the dead-man is identified by its number (`grip`, counted by the operator's side), not by an
edge, because on a latest-wins link the release between two presses may never arrive.
"""

from __future__ import annotations

from typing import final


@final
class StopLatch:
    """Who may move the robot, and whether."""

    def __init__(self) -> None:
        self.stopped = False
        self.fault = ""
        """Why the guard has stopped the robot; empty if it has not."""
        self.armed = False
        self.paused = False
        """Whether the robot came to rest by itself because writes stopped coming, and nobody has armed since."""
        self.operator = 0
        """Session of the operator who armed; 0 while there is none."""
        self.spent_grip = 0
        """Presses up to this number no longer count: only release and a new press move the robot."""

    def stop(self) -> None:
        """Latch the stop. Anyone may, at any time."""
        self.stopped = True
        self.armed = False

    def fail(self, reason: str) -> None:
        """Latch a fault, for `reason`; the first one stays."""
        self.fault = self.fault or reason
        self.armed = False

    def pause(self) -> None:
        """Take note that the robot's host is latched: only arming leads on."""
        self.paused = True
        self.armed = False

    @property
    def latched(self) -> bool:
        """Say whether it is stopped or faulted: only a reset leads out of either."""
        return self.stopped or bool(self.fault)

    def reset(self) -> None:
        """Release both latches. Nothing moves: the robot is disarmed."""
        self.stopped = False
        self.fault = ""
        self.armed = False

    def arm(self, operator: int, grip: int) -> None:
        """Arm for `operator`, unless latched; their presses up to number `grip` do not count."""
        if not self.latched:
            self.armed = True
            self.paused = False
            self.operator = operator
            self.spent_grip = grip

    def disarm(self) -> None:
        """Disarm. The robot comes to rest."""
        self.armed = False

    def spend(self, grip: int) -> None:
        """Let only a press later than `grip` move the robot from now on."""
        self.spent_grip = max(self.spent_grip, grip)
