"""What a pilot costs in a loop: a drive of it, recorded, and gone through again and again."""

from __future__ import annotations

from typing import final

from overreach.control.pilot import Pilot
from overreach.control.tick import Tick
from overreach.law.body import WholeBody
from overreach.law.frame import of_two
from overreach.model.planar import planar
from overreach.requests import ArmRequest
from overreach.robots.kinematic import KinematicRobot
from overreach.run.scenario import load_scenario
from overreach.types import Command, RobotState

DT = 0.02
"""Period [s]: a few hundred of them see the arm alone, blending and the base alone."""

Inputs = tuple[RobotState, Command, float, float]


@final
class Replay:
    """The pilot of a recorded drive; `ticks` are the arguments of its ticks, the first of which begins anew.

    A pilot holds each state against what it asked for before, so that states out of their order are a fault, and cost
    less than a tick does.
    """

    def __init__(self, law: WholeBody, count: int) -> None:
        self._law = law
        robot = KinematicRobot()
        scenario = load_scenario("mixed")
        self.ticks: list[Inputs] = []
        for k in range(count):
            now = k * DT
            twist = of_two(law.frame, *scenario.command_at(now))
            command = Command(1, k + 1, 1, True, twist, law.frame, seen=now)
            self.ticks.append((robot.read(now), command, now, DT))
            tick = self.tick(*self.ticks[-1])
            robot.write(tick.base, tick.joints, tick.gripper, now, now + DT)

    def tick(self, state: RobotState, command: Command, now: float, dt: float) -> Tick:
        """Do one tick of the drive; the first begins it anew."""
        if command.seq == 1:
            self.pilot = Pilot(planar(), self._law)
            self.pilot.ask(ArmRequest(1), now)
        return self.pilot.tick(state, command, now, dt)
