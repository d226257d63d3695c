"""Runs of robots in space: MuJoCo is the referee of every row that is written."""

from __future__ import annotations

import csv
import math
from itertools import pairwise
from pathlib import Path

import mujoco
import numpy as np
import pytest

from overreach.commands import simulate
from overreach.model.catalogue import description_of, parts_in
from overreach.model.mujoco.chain import joint_of
from overreach.plugs import load_model
from overreach.run.scenario import builtin_scenarios, load_scenario

HEADER = (
    "t,verdict,scale,mu,sigma,l,psi,z,u_x,u_y,u_z,u_wx,u_wy,u_wz,x_e,y_e,z_e,qw_e,qx_e,qy_e,qz_e,"
    "x_b,y_b,theta_b,v_b_x,v_b_y,w_b"
)
IN_SPACE = """\
description = "all of it at once"
[command]
duration = 14.0
dt = 0.01
segments = [
  {t = 0.0, v_c = 0.15, v_z = 0.03},
  {t = 4.0, v_c = 0.2, w_c = 0.15, gripper = 0.5},
  {t = 8.0, v_c = -0.1, w_c = -0.1, v_z = -0.04, w_z = -0.05},
  {t = 12.0, v_c = 0.0, v_z = 0.02},
]
"""


def rows_of(path: Path) -> tuple[list[str], list[dict[str, str]]]:
    with path.open() as file:
        reader = csv.DictReader(file)
        return list(reader.fieldnames or []), list(reader)


@pytest.mark.parametrize("robot", ["mobile7", "mobile4", "omni5"])
@pytest.mark.parametrize("scenario", ["own", "mixed"])
def test_mujoco_agrees_with_every_row(robot: str, scenario: str, tmp_path: Path) -> None:
    """The hand's pose is MuJoCo's of the logged joints; its differences are u where the scale is 1: mostly."""
    file, out = tmp_path / "own.toml", tmp_path / "run.csv"
    file.write_text(IN_SPACE)
    simulate(str(file) if scenario == "own" else scenario, robot=robot, out=out, json=True)
    names, rows = rows_of(out)
    description, folder = description_of(robot)
    joints = [group[0] for group in description.arm.groups]
    assert names == [*HEADER.split(","), *[f"q_{name}" for name in joints], *[f"dq_{name}" for name in joints]]
    model = parts_in(description, folder, "follow").model
    data = mujoco.MjData(model)
    numbers = [joint_of(model, name) for name in joints]
    hand = model.body(description.hand.body).id
    base = model.body(description.base.body).id
    at_rest = mujoco.MjData(model)
    mujoco.mj_kinematics(model, at_rest)
    places, worst_p, worst_w = [], 0.0, 0.0
    for row in rows[::7] if scenario == "mixed" else rows:
        data.qpos[model.jnt_qposadr[numbers]] = [float(row[f"q_{name}"]) for name in joints]
        mujoco.mj_kinematics(model, data)
        R_b, p_b = data.xmat[base].reshape(3, 3), data.xpos[base]
        R_h = R_b.T @ data.xmat[hand].reshape(3, 3)
        p = R_b.T @ (data.xpos[hand] - p_b) + R_h @ np.array(description.hand.offset)
        theta = float(row["theta_b"])
        turn = np.array(
            ((math.cos(theta), -math.sin(theta), 0.0), (math.sin(theta), math.cos(theta), 0.0), (0.0, 0.0, 1.0))
        )
        place = turn @ p + (float(row["x_b"]), float(row["y_b"]), 0.0)
        told = np.array([float(row[name]) for name in ("x_e", "y_e", "z_e")])
        worst_p = max(worst_p, float(np.abs(place - told).max()))
        quaternion = np.empty(4)
        mujoco.mju_mat2Quat(quaternion, (turn @ R_h).ravel())
        own = np.array([float(row[name]) for name in ("qw_e", "qx_e", "qy_e", "qz_e")])
        worst_w = max(worst_w, 2.0 * math.sqrt(max(0.0, 1.0 - float(quaternion @ own) ** 2)))
        places.append(place)
    assert worst_p < 1e-6
    assert worst_w < 1e-6
    whole = 0
    for row, after in pairwise(rows):
        if row["scale"] != "1.0" or row["verdict"] != after["verdict"]:
            continue
        whole += 1
        dt = float(after["t"]) - float(row["t"])
        for axis in "xyz":
            speed = (float(after[f"{axis}_e"]) - float(row[f"{axis}_e"])) / dt
            assert speed == pytest.approx(float(row[f"u_{axis}"]), abs=1e-3)
    assert whole >= 0.9 * (len(rows) - 1)


def test_built_in_scenarios_run_on_every_robot() -> None:
    """Scaled to its workspace: l linearly from edge to edge, psi by the half width, speeds as they are."""
    model = load_model("mobile7")
    for name in builtin_scenarios():
        one, own = load_scenario(name, "mobile7"), load_scenario(name)
        assert one.segments == own.segments
        new, old = model.workspace, own.model.workspace
        assert (one.l - new.l_min) / (new.l_max - new.l_min) == pytest.approx(
            (own.l - old.l_min) / (old.l_max - old.l_min)
        )
        assert one.psi == pytest.approx(own.psi * (new.psi_max - new.psi_min) / (old.psi_max - old.psi_min))


def test_a_file_is_not_scaled(tmp_path: Path) -> None:
    """A user's own scenario keeps the places that it says, and takes the robot's own where it says none."""
    file = tmp_path / "mine.toml"
    file.write_text("[robot]\nl = 0.6\n[command]\nduration = 1.0\nsegments = [{t = 0.0, v_z = 0.05}]\n")
    one = load_scenario(file, "mobile7")
    assert one.l == 0.6
    assert one.model.name == "mobile7"
    assert one.psi == load_model("mobile7").start.psi


def test_straight_ahead_with_the_arm_aside(tmp_path: Path) -> None:
    """8 m straight on, the arm 0.4 rad aside: the hand is never more than 1 mm off, and the base lines up behind it."""
    file, out = tmp_path / "aside.toml", tmp_path / "run.csv"
    seconds = 8.0 / 0.25
    file.write_text(
        f'[robot]\npsi = 0.4\n[command]\nduration = {seconds}\ndt = 0.01\nframe = "hand"\n'
        "segments = [{t = 0.0, v_c = 0.25}]\n"
    )
    simulate(str(file), robot="mobile7", out=out, json=True)
    _, rows = rows_of(out)
    x, y = [np.array([float(row[name]) for row in rows]) for name in ("x_e", "y_e")]
    heading = float(rows[0]["theta_b"]) + float(rows[0]["psi"])
    along = (x - x[0]) * math.cos(heading) + (y - y[0]) * math.sin(heading)
    across = (y - y[0]) * math.cos(heading) - (x - x[0]) * math.sin(heading)
    assert along[-1] > 7.9
    assert np.abs(across).max() < 1e-3
    assert abs(float(rows[-1]["psi"])) < 1e-3
