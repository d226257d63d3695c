"""Pilot and robot as the loop puts them together, without a wire: for tests by the million ticks."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

from overreach.control.decision import Decision
from overreach.control.pilot import Pilot
from overreach.law.body import WholeBody
from overreach.model.model import Model
from overreach.requests import ArmRequest, ResetRequest
from overreach.robots.imperfect import Imperfection
from overreach.robots.kinematic import KinematicRobot
from overreach.types import RobotState
from tests.said import said

ME = 11
MOST = (0.6, 2.0, 3.0, 3.0)
"""Greatest v_b [m/s], w_b, dtheta_1, dtheta_2 [rad/s] of the planar robot ..."""
CHANGE = (3.5, 12.0, 20.0, 20.0)
"""... and their greatest changes [m/s^2, rad/s^2]."""
STOP_S = 0.6 / 3.5
"""The longest v/a: a robot that is told to stop stands still within this [s] and a period."""


class Side:
    """The robot side's way of one tick. `altered` is put between the robot and whoever reads it."""

    def __init__(
        self,
        law: WholeBody | None = None,
        start: float = 50.0,
        dt: float = 0.005,
        altered: Callable[[RobotState], RobotState | None] = lambda state: state,
        imperfection: Imperfection | None = None,
        model: Model | None = None,
    ) -> None:
        self.dt = dt
        self.now = start
        self.robot = KinematicRobot(model, imperfection, now=start)
        self.pilot = Pilot(self.robot.model, law)
        self.gate, self.controller = self.pilot.gate, self.pilot.controller
        self.altered = altered
        self.seq = self.grip = 0
        self.stick = (0.0, 0.0)
        self.held = False
        self.written: list[tuple[float, ...]] = [(0.0, 0.0, 0.0, 0.0)]
        self.faulted_at: int | None = None
        """Number of the tick of the first fault."""

    def arm(self) -> None:
        self.pilot.ask(ArmRequest(ME, self.grip), self.now)
        self.grip += 1
        self.held = True

    def reset(self) -> None:
        self.pilot.ask(ResetRequest(), self.now)

    def tick(self) -> Decision:
        self.seq += 1
        state = self.altered(self.robot.read(self.now))
        command = said(ME, self.seq, self.grip, self.held, *self.stick, seen=self.now)
        tick = self.pilot.tick(state, command, self.now, self.dt)
        self.robot.write(tick.base, tick.joints, None, self.now, self.now + self.dt)
        if tick.decided.fault and self.faulted_at is None:
            self.faulted_at = len(self.written)
        self.written.append(tick.decided.rates)
        self.now += self.dt
        return tick.decided

    def drive(self, seconds: float, v_c: float = 0.4, w_c: float = 0.0) -> Decision:
        self.stick = (v_c, w_c)
        for _ in range(round(seconds / self.dt)):
            step = self.tick()
        return step

    def check(self, since: int = 0) -> None:
        """Assert that all that was written from tick number `since` on keeps speed and acceleration."""
        for before, after in pairwise(self.written[since:]):
            for was, is_, most, change in zip(before, after, MOST, CHANGE, strict=True):
                assert math.isfinite(is_)
                assert abs(is_) <= most * (1 + 1e-9)
                assert abs(is_ - was) <= change * self.dt * (1 + 1e-9)

    def check_still(self, since: int) -> None:
        """Assert that from STOP_S and a period after tick number `since` on nothing but zero was written."""
        first = since + math.ceil(STOP_S / self.dt) + 1
        assert len(self.written) > first + 10
        assert not any(any(rates) for rates in self.written[first:])
