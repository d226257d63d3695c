"""One stream driven with the pilot that the loop runs, on a robot that moves as it is told."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from overreach.arm.spatial.screws import Array
from overreach.check.streams import DT_S
from overreach.control.pilot import Pilot
from overreach.control.tick import Tick
from overreach.model.described import DescribedRobot
from overreach.requests import ArmRequest
from overreach.robots.kinematic import KinematicRobot
from overreach.types import Command, Frame, Twist

OPERATOR = 1


class Driven(NamedTuple):
    """What was commanded and what happened, step by step; states are one more than steps.

    q (N + 1, n): joints; base (N + 1, 3): x, y [m], heading [rad]; u (N, 3): the hand's commanded velocity in world
    axes [m/s], after the gate; w (N,): its turning [rad/s]; scale, mu, sigma (N,); twist (N, 3): the base twist that
    was written: v_x, v_y, w_z; rates (N, n).
    """

    q: Array
    base: Array
    u: Array
    w: Array
    scale: Array
    mu: Array
    sigma: Array
    twist: Array
    rates: Array
    verdicts: list[str]
    reasons: list[str]


def commanded(model: DescribedRobot, commands: Array) -> list[Tick]:
    """Return the ticks of a drive by commands (N, 3 or 4) of v, w, v_z, v_y: what can be replayed."""
    return [tick for tick, _ in ticks(model, commands)]


def ticks(model: DescribedRobot, commands: Array, psi: float | None = None) -> Iterator[tuple[Tick, KinematicRobot]]:
    """Drive `model` by commands (N, 3 or 4) of v, w, v_z, v_y in the frame of the hand, from its start.

    psi: the bearing [rad] at which it starts.
    """
    pilot, robot = Pilot(model), KinematicRobot(model, psi=psi)
    pilot.ask(ArmRequest(OPERATOR), 0.0)
    for k, (v, w, v_z, *aside) in enumerate(commands.tolist()):
        t = k * DT_S
        twist = Twist(v, aside[0] if aside else 0.0, v_z, w_z=w)
        command = Command(OPERATOR, k + 1, 1, True, twist, Frame.HAND, seen=t)
        tick = pilot.tick(robot.read(t), command, t, DT_S)
        robot.write(tick.base, tick.joints, tick.gripper, t, t + DT_S)
        yield tick, robot


def drive(model: DescribedRobot, commands: Array, psi: float | None = None) -> Driven:
    """Drive `model` as `ticks` does, and return what happened."""
    many, n = len(commands), len(model.arm.channels)
    found = Driven(
        np.empty((many + 1, n)), np.empty((many + 1, 3)), np.empty((many, 3)), np.empty(many), np.empty(many),
        np.empty(many), np.empty(many), np.empty((many, 3)), np.empty((many, n)), [], [],
    )  # fmt: skip
    robot = KinematicRobot(model)
    for k, (tick, moved) in enumerate(ticks(model, commands, psi)):
        robot = moved
        state = tick.decided.state
        decided = tick.decided
        bearing = state.theta_b + tick.polar.psi + model.mount.yaw
        c, s = np.cos(bearing), np.sin(bearing)
        u = decided.u
        found.q[k], found.base[k] = state.q, (state.x_b, state.y_b, state.theta_b)
        found.u[k] = (c * u.u_r - s * u.u_t, s * u.u_r + c * u.u_t, u.u_z)
        found.w[k], found.scale[k] = u.w_z, decided.scale
        found.mu[k], found.sigma[k] = decided.split.mu, decided.split.sigma
        found.twist[k], found.rates[k] = (tick.base.v_x, tick.base.v_y, tick.base.w_z), tick.joints
        found.verdicts.append(tick.verdict.value)
        found.reasons.append(tick.sentence)
    end = robot.read(many * DT_S)
    found.q[many], found.base[many] = end.q, (end.x_b, end.y_b, end.theta_b)
    return found
