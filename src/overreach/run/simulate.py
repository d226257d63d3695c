"""Run a scenario headless: the same pilot as the robot side's, a stepped clock, no wire."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import cos
from typing import Any, NamedTuple

from overreach.arm.polar import hand_in_world
from overreach.control.pilot import Pilot
from overreach.control.tick import Tick
from overreach.law.authority import ee_velocity
from overreach.law.body import WholeBody
from overreach.law.frame import FRAMES, axes, meant, of_two
from overreach.plugs import load_law
from overreach.requests import ArmRequest
from overreach.robots.kinematic import KinematicRobot
from overreach.run.law_alone import PilotAlone
from overreach.run.scenario import Scenario, load_scenario
from overreach.run.summary import Summary, summarise
from overreach.types import Command, RobotState
from overreach.verdicts import Verdict

OPERATOR = 1
"""Who drives a scenario."""


class Row(NamedTuple):
    """One line of the CSV: the state at t, and the rates applied from t to t + dt. theta: joints, a column each."""

    t: float
    v_c: float
    w_c: float
    l: float
    psi: float
    theta_e: float
    mu: float
    sigma: float
    v_b: float
    v_bm: float
    v_m: float
    w_b: float
    w_m: float
    x_b: float
    y_b: float
    theta_b: float
    x_e: float
    y_e: float
    theta: tuple[float, ...]


class Run(NamedTuple):
    """A finished run.

    rows: one a step; errors: per step, the EE's true rigid-body velocity less the commanded one,
    (radial, tangential) [m/s]; asked: per step, the base twist (v_b, w_b) that was asked for, which a slow motor
    does not give at once; summary: what happened.
    """

    scenario: Scenario
    law: str
    rows: list[Row]
    errors: list[tuple[float, float]]
    asked: list[tuple[float, float]]
    summary: Summary


def law_of(scenario: Scenario, name: str, changes: Mapping[str, Any] | None = None) -> WholeBody:
    """Return the law called `name` with the parameters and the blend of `scenario`, and `changes` of them."""
    return load_law(name, {**scenario.parameters.get(name, {}), **(changes or {})}, scenario.blend)


def pilot_for(scenario: Scenario, law: WholeBody) -> Pilot:
    """Return a new pilot for a run of `scenario`."""
    if scenario.limits is None:
        return PilotAlone(scenario.model, law)
    return Pilot(scenario.model, law, scenario.limits)


def ticks(scenario: Scenario, law: WholeBody, pilot: Pilot | None = None) -> Iterator[tuple[Tick, RobotState]]:
    """Yield (tick, what truly happens from then on) tick by tick, in constant memory: a drive with a held dead-man."""
    pilot = pilot or pilot_for(scenario, law)
    robot = KinematicRobot(scenario.model, scenario.imperfection, scenario.l, scenario.psi)
    frame = scenario.frame or law.frame
    pilot.ask(ArmRequest(OPERATOR), 0.0)
    for k in range(scenario.steps):
        t = k * scenario.dt
        command = Command(OPERATOR, k + 1, 1, True, of_two(frame, *scenario.command_at(t)), frame)
        tick = pilot.tick(robot.read(t), command, t, scenario.dt)
        robot.write(tick.base, tick.joints, tick.gripper, t, t + scenario.dt)
        yield tick, robot.true


def row_of(tick: Tick, true: RobotState, scenario: Scenario) -> tuple[Row, tuple[float, float]]:
    """Return the row of a tick, and the EE's velocity error (radial, tangential) [m/s], where the hand truly is."""
    model, twist, frame, split = scenario.model, tick.gated.twist, tick.gated.frame, tick.split
    chain = model.arm.at(true.q, model.mount)
    l, psi, theta_e = chain.l, chain.psi, tick.polar.theta_e
    x_b, y_b, theta_b, v_b, w_b = true.x_b, true.y_b, true.theta_b, true.v_b, true.w_b
    v_m, w_m = split.v_m, split.w_m
    if not scenario.imperfection.ideal:
        v_m, w_m, *_ = chain.moved(true.dq)
    psi_d = psi + model.mount.yaw
    u = meant(FRAMES[frame], twist, l, psi_d, theta_b, theta_e)
    e_r, e_t = ee_velocity(l, psi, v_b, w_b, v_m, w_m, model.mount.three)
    x_e, y_e = hand_in_world(x_b, y_b, theta_b, l, psi_d, model.mount.s_x, model.mount.s_y)
    v_c, w_c = [getattr(twist, name) for name in axes(frame)]
    row = Row(
        t=tick.now, v_c=v_c, w_c=w_c, l=l, psi=psi, theta_e=theta_e, mu=split.mu, sigma=split.sigma,
        v_b=v_b, v_bm=v_b * cos(psi_d), v_m=v_m, w_b=w_b, w_m=w_m,
        x_b=x_b, y_b=y_b, theta_b=theta_b, x_e=x_e, y_e=y_e, theta=true.q,
    )  # fmt: skip
    return row, (e_r - u.u_r, e_t - u.u_t)


def simulate(scenario: Scenario | str, law: WholeBody | str = "exact") -> Run:
    """Run `scenario` (or the built-in of that name, or a TOML file) with `law`, or the law of that name.

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
    for tick, true in ticks(scenario, law):
        row, error = row_of(tick, true, scenario)
        rows.append(row)
        errors.append(error)
        asked.append((tick.base.v_x, tick.base.w_z))
        verdicts[tick.decided.verdict] = verdicts.get(tick.decided.verdict, 0) + 1
    return Run(scenario, law.name, rows, errors, asked, summarise(scenario, law, rows, errors, verdicts))
