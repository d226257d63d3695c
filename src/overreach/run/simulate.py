"""Run a scenario headless: the same pilot as the robot side's, a stepped clock, no wire."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from overreach.control.pilot import Pilot
from overreach.control.tick import Tick
from overreach.law.body import WholeBody
from overreach.law.usual import usual_law
from overreach.plugs import load_law
from overreach.requests import ArmRequest
from overreach.robots.kinematic import KinematicRobot
from overreach.run.law_alone import PilotAlone
from overreach.run.row import Row, row_of
from overreach.run.scenario import Scenario, load_scenario
from overreach.run.spatial_row import SpatialRow, is_spatial, spatial_row
from overreach.run.summary import Summary, summarise
from overreach.types import Command, RobotState
from overreach.verdicts import Verdict

OPERATOR = 1
"""The operator's number in a scenario."""


class Run(NamedTuple):
    """A finished run.

    rows: one a step; errors: per step, the EE's true rigid-body velocity less the commanded one,
    (radial, tangential) [m/s]; asked: per step, the base twist (v_b, w_b) that was asked for, which a slow motor
    does not give at once; summary: what happened; spatial: for a robot whose arm moves in space, a row more a step.
    """

    scenario: Scenario
    law: str
    rows: list[Row]
    errors: list[tuple[float, float]]
    asked: list[tuple[float, float]]
    summary: Summary
    spatial: list[SpatialRow]


def law_of(scenario: Scenario, name: str, changes: Mapping[str, Any] | None = None) -> WholeBody:
    """Return the law called `name`, by default the robot's usual one, with the parameters and blend of `scenario`.

    changes: parameters that are to be others.
    """
    name = name or usual_law(scenario.model).name
    return load_law(name, {**scenario.parameters.get(name, {}), **(changes or {})}, scenario.blend)


def pilot_for(scenario: Scenario, law: WholeBody) -> Pilot:
    """Return a new pilot for a run of `scenario`."""
    if scenario.limits is None and not is_spatial(scenario.model):
        return PilotAlone(scenario.model, law)
    return Pilot(scenario.model, law, scenario.limits)


def ticks(scenario: Scenario, law: WholeBody, pilot: Pilot | None = None) -> Iterator[tuple[Tick, RobotState]]:
    """Yield (tick, true state with the rates from then on), in constant memory: a drive with the dead-man held."""
    pilot = pilot or pilot_for(scenario, law)
    robot = KinematicRobot(scenario.model, scenario.imperfection, scenario.l, scenario.psi)
    frame = scenario.frame or law.frame
    pilot.ask(ArmRequest(OPERATOR), 0.0)
    for k in range(scenario.steps):
        t = k * scenario.dt
        gripper = scenario.segment_at(t).gripper
        command = Command(OPERATOR, k + 1, 1, True, scenario.twist_at(t, frame), frame, gripper, t)
        tick = pilot.tick(robot.read(t), command, t, scenario.dt)
        robot.write(tick.base, tick.joints, tick.gripper, t, t + scenario.dt)
        yield tick, robot.true


def simulate(scenario: Scenario | str, law: WholeBody | str = "") -> Run:
    """Run `scenario` (or the built-in of that name, or a TOML file) with `law`, or the law of that name.

    By default with the law that suits its robot.

    Raises SetupError when the scenario or the law cannot be used; a run itself raises nothing.
    """
    if isinstance(scenario, str):
        scenario = load_scenario(scenario)
    if isinstance(law, str):
        law = law_of(scenario, law)
    rows: list[Row] = []
    errors: list[tuple[float, float]] = []
    asked: list[tuple[float, float]] = []
    verdicts: dict[Verdict, int] = {}
    in_space = is_spatial(scenario.model)
    spatial: list[SpatialRow] = []
    for tick, true in ticks(scenario, law):
        row, error = row_of(tick, true, scenario)
        rows.append(row)
        errors.append(error)
        asked.append((tick.base.v_x, tick.base.w_z))
        if in_space:
            spatial.append(spatial_row(tick, true, scenario.model))
        verdicts[tick.decided.verdict] = verdicts.get(tick.decided.verdict, 0) + 1
    return Run(scenario, law.name, rows, errors, asked, summarise(scenario, law, rows, errors, verdicts), spatial)
