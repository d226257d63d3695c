"""What a controller costs in a loop: a drive of it, recorded, and gone through again and again."""

from __future__ import annotations

from typing import final

from overreach.control.controller import HandController
from overreach.law.body import WholeBody
from overreach.robots.kinematic import KinematicRobot
from overreach.run.scenario import load_scenario
from overreach.types import RobotState, Step

DT = 0.02
"""Period [s]: a few hundred of them see the arm alone, blending and the base alone."""

Ticks = list[tuple[RobotState, float, float, float, float]]


@final
class Replay:
    """The controller of a recorded drive; `ticks` are the arguments of its steps, the first of which begins anew.

    A controller holds each state against what it asked for before, so that states out of their order are a fault, and
    cost less than a step does.
    """

    def __init__(self, law: WholeBody, count: int) -> None:
        robot = KinematicRobot()
        self.controller = HandController(robot.model, law)
        scenario = load_scenario("mixed")
        self.ticks: Ticks = []
        for k in range(count):
            now = k * DT
            command = scenario.command_at(now)
            self.ticks.append((robot.read(now), command.v_c, command.w_c, DT, now))
            step = self.step(*self.ticks[-1])
            robot.write(step.twist, step.dtheta, now)

    def step(self, state: RobotState, v_c: float, w_c: float, dt: float, now: float) -> Step:
        """Do one step of the drive; the first begins it anew."""
        if now == 0.0:
            self.controller.restart()
        return self.controller.step(state, v_c, w_c, dt, now)
