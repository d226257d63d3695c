"""What every robot is to keep with `exact`, each with its limit: random streams, and a few drives that are laid out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from overreach.arm.spatial.screws import Array
from overreach.check.check import check, way_out
from overreach.check.driven import Driven, drive
from overreach.check.judge import in_world
from overreach.check.streams import DT_S
from overreach.model.catalogue import load_one
from overreach.model.described import DescribedRobot
from overreach.types import Record

STRAIGHT_M, OUT_M = 8.0, 2.0
"""How far the hand is driven straight on with the arm aside, and outward until the arm is to be back [m]."""
CIRCLE_S, SETTLED_S = 60.0, 15.0
"""How long the base carries the hand round in a circle, and from when on its place is looked at [s]."""
ASIDE = 0.5
"""Where the arm is put, in parts of the bearings that it works at."""
WAITING, LEAST_SCALE = 0.995, 0.95
"""A hand that waits while its base swings goes its way, too: so much of the time, and so much of it."""
STANDS = 1e-6
"""A base that moves by less [m] stands still: a telescope is not quite straight in its model."""
LINED_UP = 0.02
"""The base has lined up where its heading is so near [rad] the way of the hand."""


class Property(Record, frozen=True):
    """One property of one robot in one mode: its value, what it may be at most or at least, and whether it is kept."""

    robot: str
    mode: str
    name: str
    value: float
    limit: float
    least: bool = False

    @property
    def kept(self) -> bool:
        """Whether it is kept."""
        return self.value >= self.limit if self.least else self.value <= self.limit


def properties(
    which: str, streams: int, seed: int, jobs: int = 0, progress: Callable[[int], None] = lambda _: None
) -> list[Property]:
    """Return the properties of a robot. progress: called with the number of streams done. Raises SetupError."""
    model = load_one(which)
    found: list[Property] = []

    def add(name: str, value: float, limit: float, least: bool = False) -> None:
        found.append(Property(model.name, model.mode, name, float(value), limit, least))

    smooth = check(which, streams, seed, "smooth", jobs, progress)
    steps = check(which, streams, seed, "steps", jobs, lambda done: progress(streams + done))
    aside = model.arm.aside
    add("smooth steps that are exact [of 1]", smooth.ok_share, WAITING if aside else 0.9999, least=True)
    add("stick steps that are exact [of 1]", steps.ok_share, 0.999, least=True)
    if aside:
        add("scale, mean [of 1]", smooth.mean_scale, LEAST_SCALE, least=True)
    add("velocity error, rms [m/s]", smooth.ee_error_rms, 1e-5)
    add("velocity error, most [m/s]", smooth.ee_error_max, 1e-3)
    add("attitude error, most [rad]", smooth.orientation_error_max, 1e-3)
    add("joint limits passed", smooth.joint_limit_violations + steps.joint_limit_violations, 0.0)
    add("contacts with itself", smooth.self_contacts + steps.self_contacts, 0.0)
    if not model.base.omni:
        add("sideways velocity of the base [m/s]", max(smooth.lateral_base_max, steps.lateral_base_max), 0.0)
    add("beyond the edges in l [m]", smooth.out_l, 3e-3)
    add("beyond the edges in psi [rad]", smooth.out_psi, 0.03)
    add("beyond the edges in z [m]", smooth.out_z, 1e-3)
    add("base path of a reach inside [m]", smooth.reach_base_path, STANDS if aside else 0.0)
    off, heading = straight(model)
    add(f"off a straight line of {STRAIGHT_M:g} m, arm aside [m]", off, 1e-3)
    if not model.base.omni:
        add("base's heading off the line at its end [rad]", heading, LINED_UP)
    add(f"from mid-reach after {OUT_M:g} m outward [m]", recentred(model), 0.01)
    add(f"creep in a circle of {CIRCLE_S:g} s [m]", creep(model), 1e-3)
    return found


def _hand(model: DescribedRobot, driven: Driven) -> tuple[Array, Array, Array]:
    """Return the hand's x and y in the world, and its length about the shoulder, at each state [m]."""
    _, p, _ = model.arm.posture_at_home.forward(driven.q)
    x, y = in_world(model, driven.base, p)
    return x, y, np.hypot(p[:, 0], p[:, 1])


def straight(model: DescribedRobot) -> tuple[float, float]:
    """Return how far [m] the hand is off its straight line at most, and the base's heading off it at the end [rad]."""
    v = model.command.v_c
    psi = 0.0 if model.arm.aside else ASIDE * model.workspace.psi_max
    driven = drive(model, outward(model, round(STRAIGHT_M / v / DT_S)), psi=psi)
    x, y, _ = _hand(model, driven)
    way = model.mount.yaw + psi
    off = (y - y[0]) * np.cos(way) - (x - x[0]) * np.sin(way)
    half = np.pi if model.arm.aside else 2.0 * np.pi  # it may be driven backward as well
    turned = (driven.base[-1, 2] - way + 0.5 * half) % half - 0.5 * half
    return float(np.abs(off).max()), abs(float(turned))


def outward(model: DescribedRobot, steps: int) -> Array:
    """Return commands (steps, 4) of v, w, v_z, v_y that move the hand outward from where it starts, at full speed."""
    return np.tile(model.command.v_c * way_out(model), (steps, 1))


def recentred(model: DescribedRobot) -> float:
    """Return how far [m] the arm is from mid-reach after a drive outward that is let go."""
    space = model.workspace
    commands = np.zeros((round(OUT_M / model.command.v_c / DT_S) + round(1.0 / DT_S), 4))
    commands[: -round(1.0 / DT_S)] = outward(model, len(commands) - round(1.0 / DT_S))
    *_, l = _hand(model, drive(model, commands))
    return abs(float(l[-1]) - 0.5 * (space.l_min + space.l_max))


def creep(model: DescribedRobot) -> float:
    """Return by how much [m] the hand's length changes while the base carries it round in a circle."""
    commands = np.zeros((round(CIRCLE_S / DT_S), 3))
    commands[:, 0], commands[:, 1] = 0.9 * model.command.v_c, 0.5 * model.command.w_c
    *_, l = _hand(model, drive(model, commands))
    return float(np.ptp(l[round(SETTLED_S / DT_S) :]))
