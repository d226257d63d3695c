"""Many streams, and what they came to together."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import cache, partial
from multiprocessing import get_context

import numpy as np

from overreach.arm.spatial.engine import warm
from overreach.arm.spatial.screws import Array
from overreach.check.driven import drive
from overreach.check.judge import Judged, judge
from overreach.check.streams import DT_S, stream
from overreach.model.catalogue import load, load_one, parts_for
from overreach.model.described import DescribedRobot
from overreach.model.mujoco.contact import Contacts
from overreach.model.workspace import Workspace
from overreach.types import Record

REACH_M = 0.1
"""The reach inside the workspace that should not move the base."""


class Found(Record, frozen=True):
    """What `streams` of a kind came to. ok: steps whose scale is 1 and whose error, by kinematics, is in bounds.

    Errors [m/s, rad] are those of OK steps; base_share: part of the time in which the base has most of the motion;
    omni: whether the base moves sideways too; crossings: of the middles of the blends, a stream; out_l, out_psi,
    out_z [m, rad, m]: beyond the outer edges of the workspace at most; reach_base_path [m]: how far the base went
    for a reach of REACH_M inside the workspace.
    """

    robot: str
    mode: str
    kind: str
    streams: int
    seed: int
    v: float
    w: float
    v_z: float
    ok_share: float
    streams_all_ok: int
    ee_error_rms: float
    ee_error_max: float
    orientation_error_max: float
    mean_scale: float
    base_share: float
    speed_rms: float
    speed_max: float
    crossings: float
    joint_limit_violations: int
    min_joint_gap: float
    self_contacts: int
    lateral_base_max: float
    omni: bool
    out_l: float
    out_psi: float
    out_z: float
    reach_base_path: float


@cache
def _robot(which: str) -> tuple[DescribedRobot, Contacts]:
    load.cache_clear()  # anew: with compiled code, if that has been made since
    model = load_one(which)
    return model, parts_for(which).contacts(HALF_DISTANCE)


HALF_DISTANCE = 0.5
"""Contacts are looked for at this part of the distance that the workspace was measured with."""


def _one(which: str, kind: str, seed: int, guess: Workspace | None, number: int) -> Judged:
    model, contacts = _robot(which)
    if guess is not None:
        model = model.driven_in(guess)
    driven = drive(model, stream(kind, seed, number, model.command, model.base.omni))
    return judge(model, driven, lambda q: bool(contacts.touching(q)))


def judged(
    which: str, kind: str, streams: int, seed: int, jobs: int = 0, guess: Workspace | None = None
) -> Iterator[Judged]:
    """Yield each stream's judgement, in order, by `jobs` processes (0: one a core; 1: this one)."""
    one = partial(_one, which, kind, seed, guess)
    jobs = jobs or min(streams, os.cpu_count() or 1)
    if jobs == 1:
        yield from map(one, range(streams))
        return
    with ProcessPoolExecutor(jobs, get_context("spawn")) as pool:
        yield from pool.map(one, range(streams), chunksize=max(1, min(8, streams // (2 * jobs))))


def check(
    which: str,
    streams: int = 200,
    seed: int = 0,
    kind: str = "smooth",
    jobs: int = 0,
    progress: Callable[[int], None] = lambda _: None,
    guess: Workspace | None = None,
) -> Found:
    """Return what `streams` streams came to on the robot `which`. Raises SetupError.

    guess: a workspace that is driven in instead of the one that was measured, to see what measuring is good for.
    """
    warm()
    model, _ = _robot(which)
    each = []
    for one in judged(which, kind, streams, seed, jobs, guess):
        each.append(one)
        progress(len(each))
    ok = np.concatenate([one.ok for one in each]).astype(bool)
    off_v, off_w = [np.concatenate([getattr(one, name) for one in each])[ok] for name in ("off_v", "off_w")]
    speed = np.concatenate([one.speed for one in each])
    most = model.command
    return Found(
        robot=model.name, mode=model.mode, kind=kind, streams=streams, seed=seed, v=most.v_c, w=most.w_c, v_z=most.v_z,
        ok_share=float(ok.mean()),
        streams_all_ok=sum(bool(one.ok.all()) for one in each),
        ee_error_rms=_rms(off_v), ee_error_max=_most(off_v), orientation_error_max=_most(off_w),
        mean_scale=float(np.mean([one.scale.mean() for one in each])),
        base_share=float(np.mean([one.based for one in each])),
        speed_rms=_rms(speed), speed_max=_most(speed),
        crossings=float(np.mean([one.crossings for one in each])),
        joint_limit_violations=sum(one.violations for one in each),
        min_joint_gap=min(one.gap for one in each),
        self_contacts=sum(one.contacts for one in each),
        lateral_base_max=max(one.lateral for one in each),
        omni=model.base.omni,
        out_l=max(one.out_l for one in each), out_psi=max(one.out_psi for one in each),
        out_z=max(one.out_z for one in each),
        reach_base_path=reach_base_path(model)[1],
    )  # fmt: skip


def way_out(model: DescribedRobot) -> Array:
    """Return v, w, v_z, v_y (4,) that move the hand outward from where it starts, at 1 m/s, in its own frame."""
    facing = model.arm.at(model.arm.posture(model.start.l, model.start.psi), model.mount).facing
    return np.array((np.cos(facing), 0.0, 0.0, -np.sin(facing)))


def reach_base_path(model: DescribedRobot) -> tuple[float, float]:
    """Return (length, path) [m]: how far the base goes for a reach along l inside the workspace, out and back.

    The reach is of REACH_M, or of what fits between the bands.
    """
    space, most = model.workspace, model.command
    q, p, _ = model.bands
    l_min, l_max, *_ = space.middles(q, p)
    length = min(REACH_M, 0.98 * (l_max - l_min - q))
    v = 0.5 * most.v_c
    ramp = v / most.dv_c
    there = round((0.5 * length / v + ramp) / DT_S)
    back = round((length / v + ramp) / DT_S)
    commands = np.zeros((2 * there + back + 100, 4))
    outward = way_out(model) * v
    commands[: there - round(ramp / DT_S)] = outward
    commands[there : there + back - round(ramp / DT_S)] = -outward
    driven = drive(model, commands)
    return length, float(np.hypot(*np.diff(driven.base[:, :2], axis=0).T).sum())


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0


def _most(values: Array) -> float:
    return float(values.max()) if len(values) else 0.0
