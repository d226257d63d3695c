"""One period, whole: what went into it and what came of it. Rows, wire states and plots are views of it, by name."""

from __future__ import annotations

from overreach.gate.gate import Gated
from overreach.requests import Request
from overreach.types import BaseTwist, Command, Decision, PolarState, Record, RobotState, Split
from overreach.verdicts import Verdict, weightier


class Tick(Record, frozen=True):
    """All inputs and decisions of one tick.

    In: now, dt [s]; state: what the robot reported; command: the message that came, if one did; requests: what was
    asked since the tick before. Out: gated: what the gate let through; decided: what is written, and why; armed,
    latched, operator: as the gate's latch was left.
    """

    now: float
    dt: float
    state: RobotState | None
    command: Command | None
    requests: tuple[Request, ...]
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
        """The gripper's opening that is written, 0 to 1; None where it is to stay."""
        return self.gated.gripper

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
        """The part of what was asked for that is carried out."""
        return self.gated.scale * self.decided.scale

    @property
    def verdict(self) -> Verdict:
        """What became of the command: of what gate and law say the weightier."""
        return weightier(self.gated.verdict, self.decided.verdict)

    @property
    def sentence(self) -> str:
        """The verdict in words, with its reason where it has one."""
        verdict = self.verdict
        reason = self.decided.fault if verdict is Verdict.FAULT else self.gated.reason
        return f"{reason} {verdict.sentence}".strip()
