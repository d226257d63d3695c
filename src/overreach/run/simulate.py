"""Run a scenario headless: the same controller as the robot side, a stepped clock, no wire."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import cos
from typing import Any, NamedTuple

from overreach.arm.polar import hand_in_world
from overreach.control.controller import HandController
from overreach.gate.limits import limit_speed, slew
from overreach.law.authority import ee_velocity
from overreach.law.body import WholeBody
from overreach.plugs import load_law
from overreach.robots.kinematic import KinematicRobot
from overreach.run.law_alone import LawAlone
from overreach.run.scenario import Scenario, load_scenario
from overreach.run.summary import Summary, summarise
from overreach.types import Step, Verdict


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


def steps(scenario: Scenario, law: WholeBody) -> Iterator[tuple[Row, tuple[float, float], Step]]:
    """Yield (row, EE velocity error (radial, tangential) [m/s], what was decided) step by step, in constant memory."""
    model = scenario.model
    limits = scenario.limits
    if limits is None:
        controller: HandController = LawAlone(model, law, scenario.frame)
    else:
        controller = HandController(model, law, scenario.frame, ramp_s=limits.ramp_s)
    robot = KinematicRobot(model, scenario.imperfection, scenario.l, scenario.psi)
    mount = model.mount.three
    dt = scenario.dt
    v_c = w_c = 0.0
    for k in range(scenario.steps):
        t = k * dt
        wish = scenario.command_at(t)
        if limits is None:
            v_c, w_c = wish.v_c, wish.w_c
        else:
            goal_v, goal_w, _ = limit_speed(wish.v_c, wish.w_c, limits)
            v_c, w_c, _ = slew((v_c, w_c), (goal_v, goal_w), limits, dt)
        done = controller.step(robot.read(t), v_c, w_c, dt, t)
        robot.write(done.twist, done.dtheta, t)
        # What was asked for and what really happens, both seen where the hand truly is.
        true = robot.true
        chain = model.arm.at(true.theta, model.mount)
        l, psi = chain.l, chain.psi
        theta_e = done.polar.theta_e
        split = done.split
        if scenario.imperfection.ideal:
            v_m, w_m = split.v_m, split.w_m
        else:
            v_m, w_m, *_ = chain.moved(true.dtheta)
        u_r, u_t = controller.commanded(v_c, w_c, l, psi, true.theta_b, theta_e)
        e_r, e_t = ee_velocity(l, psi, true.v_b, true.w_b, v_m, w_m, mount)
        psi_d = psi + model.mount.yaw
        x_e, y_e = hand_in_world(true.x_b, true.y_b, true.theta_b, l, psi_d, model.mount.s_x, model.mount.s_y)
        yield (
            Row(
                t, v_c, w_c, l, psi, theta_e, split.mu, split.sigma,
                true.v_b, true.v_b * cos(psi_d), v_m, true.w_b, w_m,
                true.x_b, true.y_b, true.theta_b, x_e, y_e, true.theta,
            ),
            (e_r - u_r, e_t - u_t),
            done,
        )  # fmt: skip


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
    for row, error, done in steps(scenario, law):
        rows.append(row)
        errors.append(error)
        asked.append((done.split.v_b, done.split.w_b))
        verdicts[done.verdict] = verdicts.get(done.verdict, 0) + 1
    return Run(scenario, law.name, rows, errors, asked, summarise(scenario, law, rows, errors, verdicts))
