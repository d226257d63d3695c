"""One control period: all that went in and all that came out. Rows, wire states and plots are views of it."""

from __future__ import annotations

from overreach.control.decision import Decision
from overreach.gate.gate import Gated
from overreach.law.body import Planner, WholeBody
from overreach.model.model import Model
from overreach.requests import Request
from overreach.types import BaseTwist, Command, PolarState, Record, RobotState, Split
from overreach.verdicts import Verdict, weightier


class Failed(Record, frozen=True):
    """From outside the pilot: something has failed, and why."""

    reason: str


class Configured(Record, frozen=True):
    """Another law, workspace or speed came into force. planner: the law's, for the model; it was made before."""

    law: WholeBody
    model: Model
    speed_scale: float
    planner: Planner


class Tick(Record, frozen=True):
    """All inputs and decisions of one tick.

    In: now, dt [s]; state: what the robot reported; command: the message that came, if any; requests: those made since
    the previous tick. Out: gated: what the gate let through; decided: what is written, and why; armed, latched,
    operator: of the gate's latch, at the end of the tick.
    """

    now: float
    dt: float
    state: RobotState | None
    command: Command | None
    requests: tuple[Request | Failed | Configured, ...]
    gated: Gated
    decided: Decision
    armed: bool
    latched: bool
    operator: int

    @property
    def base(self) -> BaseTwist:
        """The base twist that is written."""
        return self.decided.base

    @property
    def joints(self) -> tuple[float, ...]:
        """The joint rates that are written [rad/s, m/s]."""
        return self.decided.joints

    @property
    def gripper(self) -> float | None:
        """The gripper opening that is written, 0 to 1; None to leave it as it is."""
        return None if self.decided.fault else self.gated.gripper

    @property
    def polar(self) -> PolarState:
        """Where the hand is."""
        return self.decided.polar

    @property
    def split(self) -> Split:
        """The shares, with the rates as they are written."""
        return self.decided.split

    @property
    def scale(self) -> float:
        """The part of the command that is carried out, 0 to 1."""
        return self.gated.scale * self.decided.scale

    @property
    def verdict(self) -> Verdict:
        """What became of the command: the weightier of the gate's verdict and the decision's."""
        return weightier(self.gated.verdict, self.decided.verdict)

    @property
    def sentence(self) -> str:
        """The verdict in words, with its reason where it has one."""
        verdict = self.verdict
        decided = self.decided
        if verdict is Verdict.FAULT:
            reason = decided.fault
        else:
            reason = decided.reason if verdict is decided.verdict and decided.reason else self.gated.reason
        return f"{reason} {verdict.sentence}".strip()
