"""One line of a run: a view of its tick, beside what truly happened."""

from __future__ import annotations

from math import cos
from typing import NamedTuple

from overreach.arm.polar import hand_in_world
from overreach.control.tick import Tick
from overreach.law.authority import ee_velocity
from overreach.law.frame import FRAMES, axes, meant
from overreach.run.scenario import Scenario
from overreach.types import RobotState


class Row(NamedTuple):
    """One line of the CSV: the state at t, and the rates applied from t to t + dt. theta: joints, one column each."""

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


def row_of(tick: Tick, true: RobotState, scenario: Scenario) -> tuple[Row, tuple[float, float]]:
    """Return the row of a tick, and the EE's velocity error (radial, tangential) [m/s] at the hand's true position."""
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
