"""Random streams: what they are, how they are judged, and what our robots make of them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from overreach.check.check import check, reach_base_path
from overreach.check.driven import Driven, drive
from overreach.check.judge import judge
from overreach.check.streams import DT_S, stream
from overreach.gate.limits import Limits
from overreach.model.described import DescribedRobot
from overreach.plugs import load_model

MOST = Limits(0.3, 0.3, 3.0, 3.0, 0.08, 0.8)


def mobile4() -> DescribedRobot:
    model = load_model("mobile4")
    assert isinstance(model, DescribedRobot)
    return model


def test_streams_are_what_they_say() -> None:
    """The same for the same seed, others for others; full deflection is reached and never passed, steps are steps."""
    one = stream("smooth", 3, 5, MOST)
    assert (one == stream("smooth", 3, 5, MOST)).all()
    assert not (one == stream("smooth", 3, 6, MOST)).all()
    assert not (one == stream("smooth", 4, 5, MOST)).all()
    assert one.shape == (2000, 3)
    assert np.abs(one).max(axis=0) == pytest.approx((0.3, 0.3, 0.08))
    assert np.abs(np.diff(one, axis=0)).max(axis=0)[0] < 2.0 * DT_S
    four = stream("smooth", 3, 5, MOST, aside=True)
    assert (four[:, :3] == one).all()
    assert np.abs(four[:, 3]).max() == pytest.approx(0.3)
    steps = stream("steps", 3, 5, MOST)
    assert 5 < np.count_nonzero(np.diff(steps[:, 0])) < 60
    assert (np.abs(steps) <= (0.3, 0.3, 0.08)).all()


def driven() -> Driven:
    return drive(mobile4(), stream("smooth", 1, 0, mobile4().command))


def test_a_judge_that_is_told_the_truth() -> None:
    """Every step of a stream is OK; and each kind of failure is seen where it is put in, and nowhere else."""
    model, found = mobile4(), driven()
    fine = judge(model, found, lambda q: False)
    assert fine.ok.all()
    assert (fine.violations, fine.contacts, fine.lateral) == (0, 0, 0.0)

    slow = found.u.copy()
    slow[700] += (0.002, 0.0, 0.0)
    assert np.flatnonzero(~judge(model, found._replace(u=slow), lambda q: False).ok).tolist() == [700]
    scaled = found.scale.copy()
    scaled[900:903] = 0.5
    assert set(range(900, 903)) <= set(np.flatnonzero(~judge(model, found._replace(scale=scaled), lambda q: False).ok))
    tilted = found.q.copy()
    tilted[1200, -1] += 0.02  # the pitch of the hand, and its place
    wrong = judge(model, found._replace(q=tilted), lambda q: False)
    assert set(np.flatnonzero(~wrong.ok)) == {1199, 1200}
    assert wrong.off_w[1199] == pytest.approx(0.02, rel=1e-3)
    over = found.q.copy()
    over[50, 2] = model.arm.limits[2, 1] + 0.01
    assert judge(model, found._replace(q=over), lambda q: False).violations == 1
    aside = found.twist.copy()
    aside[3, 1] = 0.01
    assert judge(model, found._replace(twist=aside), lambda q: False).lateral == 0.01
    assert judge(model, found, lambda q: True).contacts == len(found.q[::50])


@pytest.mark.parametrize(
    ("robot", "kind"),
    [
        ("mobile7", "smooth"),
        ("mobile7", "steps"),
        ("mobile7#fixed", "smooth"),
        ("mobile4", "smooth"),
        ("mobile4", "steps"),
        ("omni7", "smooth"),
        ("omni5", "smooth"),
    ],
)
def test_our_robots_follow(robot: str, kind: str) -> None:
    """50 streams of 20 s: every smooth step is exact, in and across the workspace; of stick steps 999 in 1,000."""
    found = check(robot, 50 if kind == "smooth" else 20, 7, kind, jobs=1)  # other tests run beside it
    if kind == "smooth":
        assert found.ok_share >= 0.9999
        assert found.base_share > 0.45
        assert found.crossings > 4.0
    else:
        assert found.ok_share >= 0.999
    assert found.ee_error_rms <= 1e-5
    assert found.ee_error_max <= 1e-3
    assert found.orientation_error_max <= 1e-3
    assert found.joint_limit_violations == found.self_contacts == 0
    assert found.lateral_base_max == 0.0 or robot.startswith("omni")
    assert found.out_l <= 3e-3
    assert found.out_psi <= 0.03
    assert found.out_z <= 1e-3
    assert found.speed_max > found.v


def test_a_reach_inside_leaves_the_base_alone() -> None:
    """A reach that fits between the bands: the base does not move at all."""
    for robot in ("mobile7", "mobile7#fixed", "mobile4", "omni7", "omni5"):
        model = load_model(robot)
        assert isinstance(model, DescribedRobot)
        length, path = reach_base_path(model)
        assert path == 0.0
        assert length == pytest.approx(0.1) or robot in ("mobile4", "omni5")


@pytest.mark.parametrize("w", [0.3, -0.2])
def test_a_hand_that_is_carried_does_not_creep_away(w: float) -> None:
    """Once the base carries the hand alone, round in a circle for a minute, length and bearing stay where they were."""
    model = load_model("mobile7")
    assert isinstance(model, DescribedRobot)
    commands = np.tile((0.9 * model.command.v_c, w, 0.0), (7000, 1))
    driven = drive(model, commands)
    _, p, _ = model.arm.posture_at_home.forward(driven.q[1500:])
    l, psi = np.hypot(p[:, 0], p[:, 1]), np.arctan2(p[:, 1], p[:, 0])
    assert driven.mu[1500:].min() > 0.99
    assert np.abs(l - l[0]).max() < 1e-3
    assert np.abs(psi - psi[0]).max() < 0.01


@pytest.mark.parametrize(("robot", "v", "w"), [("omni7", 0.7, 0.25), ("mobile7", 0.7, 0.25)])
def test_a_hand_that_is_carried_and_swept_does_not_creep_away(robot: str, v: float, w: float) -> None:
    """While the base carries the hand outward and the arm sweeps it from one bearing to another, the length stays."""
    model = load_model(robot)
    assert isinstance(model, DescribedRobot)
    first = np.tile((model.command.v_c, 0.0, 0.0), (500, 1))
    driven = drive(model, np.concatenate((first, np.tile((v * model.command.v_c, w, 0.0), (700, 1)))))
    _, p, _ = model.arm.posture_at_home.forward(driven.q[500:])
    l, psi = np.hypot(p[:, 0], p[:, 1]), np.arctan2(p[:, 1], p[:, 0])
    assert driven.mu[500:].min() > 0.9
    assert np.ptp(psi) > 0.05
    assert l.max() <= model.workspace.l_max + 1e-5


def test_processes_do_not_change_the_numbers(tmp_path: Path) -> None:
    """By one process or two: the same numbers, in the file as well."""
    from overreach.commands import check as command

    one = check("mobile4", 4, 2, "smooth", jobs=1)
    assert check("mobile4", 4, 2, "smooth", jobs=2) == one
    command("mobile4", streams=4, seed=2, json=tmp_path / "found.json", jobs=1)
    told = json.loads((tmp_path / "found.json").read_text())
    assert told["smooth"]["ok_share"] == one.ok_share
    assert set(told) == {"smooth", "steps"}
