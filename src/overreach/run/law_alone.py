"""The law itself, without the robot's limits: what a scenario without a table [limits] shows. Simulation only."""

from __future__ import annotations

from math import isfinite
from typing import final

from overreach.arm.chain import Chain
from overreach.control.bounds import Bounds
from overreach.control.controller import HandController
from overreach.control.decision import Decision
from overreach.control.pilot import Pilot
from overreach.gate.gate import STILL, Gated
from overreach.law.body import WholeBody
from overreach.model.model import Model
from overreach.types import Command, Frame, RobotState
from overreach.verdicts import Motion, Verdict


@final
class NoBounds(Bounds):
    """Bounds that bind nothing."""

    def keep(self, *_: object) -> bool:
        """Say that nothing binds."""
        return True


@final
class LawAlone(HandController):
    """A controller that bounds nothing and only checks that rates are finite. Nothing that moves a robot imports it."""

    def _believe(self, state: RobotState | None, dt: float, now: float | None) -> None:
        if state is not None:
            self._now = state.t if now is None else now
            self._feedback.asked.move_to(state.t)
            self._believed = state

    def _asks(self, _motion: Motion) -> bool:
        return True

    def _bounded(self, model: Model) -> Bounds:
        return NoBounds(model, self.guard)

    def _last_word(
        self, decision: Decision, chain: Chain, motion: Motion, dt: float
    ) -> tuple[Decision, tuple[float, ...]]:
        rates = decision.rates
        if isfinite(sum(map(abs, rates))):
            return decision, rates
        self.guard.latch(f"The law {self.name!r} gave rates that are not finite: {rates}.")
        decision = self._at_rest(chain, decision.state)
        return decision, decision.rates


@final
class PilotAlone(Pilot):
    """A pilot whose gate lets everything through at once, with a controller that bounds nothing."""

    def _controller(self, model: Model, law: WholeBody) -> HandController:
        return LawAlone(model, law)

    def _gated(self, command: Command | None, now: float, dt: float) -> Gated:
        twist, frame = (command.twist, command.frame) if command else (STILL, Frame.HAND)
        return Gated(twist, frame, None, 1.0, Motion.ALLOWED, Verdict.MOVING)
