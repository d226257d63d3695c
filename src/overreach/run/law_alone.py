"""The law itself, without the robot's limits: what a scenario without a table [limits] shows. Simulation only."""

from __future__ import annotations

from math import isfinite
from typing import final

from overreach.arm.chain import Chain
from overreach.control.controller import HandController
from overreach.types import Motion, RobotState, Step, Verdict


@final
class LawAlone(HandController):
    """A controller that bounds nothing: every rate is finite, that is all. Nothing that moves a robot imports it."""

    def _believe(self, state: RobotState | None, dt: float, now: float | None) -> None:
        if state is not None:
            self._now = state.t if now is None else now
            self._feedback.asked.move_to(state.t)
            self._believed = state

    def _asks(self, _motion: Motion) -> bool:
        return True

    def _limit(self, *_: object) -> tuple[float, Verdict]:
        return 1.0, Verdict.MOVING

    def _base(self, v_b: float, w_b: float, dt: float) -> tuple[float, float]:
        return v_b, w_b

    def _bounded(self, joints: tuple[float, ...], *_: object) -> tuple[float, ...]:
        return joints

    def _last_word(self, step: Step, chain: Chain, motion: Motion, dt: float) -> Step:
        if isfinite(sum(map(abs, step.rates))):
            return step
        self.guard.latch(f"The law {self.name!r} gave rates that are not finite: {step.rates}.")
        return self._at_rest(chain, step.state)
