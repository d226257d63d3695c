"""A real robot, from its maker's own model: measured, refused where its keyframe would have it, and driven."""

from __future__ import annotations

from pathlib import Path

import msgspec
import mujoco
import numpy as np
import pytest

from overreach.check.check import check
from overreach.errors import WorkspaceError
from overreach.model.catalogue import description_of, measured, parts_in
from overreach.model.measure.rank import holds
from overreach.model.mujoco.chain import joint_of

KEYFRAME = (0.20, -1.34, -0.20, 1.94, -1.57, 1.37, 0.0)
"""The posture of `home` in the model file: the hand is beside the base."""


def test_its_kinematics_are_mujoco_s(menagerie: Path) -> None:
    """At random joints, its lift at its place, the hand is where MuJoCo has it."""
    description, folder = description_of("tiago")
    found = parts_in(description, folder, "follow")
    model, data = found.model, mujoco.MjData(found.model)
    joints = [joint_of(model, group[0]) for group in description.arm.groups]
    for name, value in description.locked.items():
        data.qpos[model.jnt_qposadr[joint_of(model, name)]] = value
    base, hand = model.body(description.base.body).id, model.body(description.hand.body).id
    random = np.random.default_rng(0)
    for _ in range(50):
        q = random.uniform(found.arm.limits[:, 0], found.arm.limits[:, 1])
        data.qpos[model.jnt_qposadr[joints]] = q
        mujoco.mj_kinematics(model, data)
        R_b, R_h = data.xmat[base].reshape(3, 3), data.xmat[hand].reshape(3, 3)
        p = R_b.T @ (data.xpos[hand] + R_h @ np.array(description.hand.offset) - data.xpos[base])
        chain = found.arm.at(tuple(q.tolist()), found.mount)
        assert np.abs(np.array(chain.hand) - p).max() < 1e-12
        assert np.abs(chain.attitude - R_b.T @ R_h).max() < 1e-12


def test_what_ships_is_what_is_measured(menagerie: Path) -> None:
    """The description's tables are of the menagerie's model, and measuring again gives the same numbers."""
    description, folder = description_of("tiago")
    for mode, shipped in description.workspace.items():
        found = parts_in(description, folder, mode)
        assert found.key == shipped.model, mode
        if mode == "follow":
            assert measured(found).measured == shipped


def test_its_keyframe_is_no_home(menagerie: Path) -> None:
    """The posture of its model file has the hand beside the base: refused, with the reason."""
    description, folder = description_of("tiago")
    aside = msgspec.structs.replace(description, home=KEYFRAME, homes={})
    with pytest.raises(WorkspaceError, match="home is beside the base"):
        measured(parts_in(aside, folder, "follow"))


def test_it_holds_all(menagerie: Path) -> None:
    """Seven joints hold every turning."""
    description, folder = description_of("tiago")
    assert holds(parts_in(description, folder, "follow").arm) == 7


def test_it_follows(menagerie: Path) -> None:
    """50 smooth streams: every step is exact, in and across its workspace."""
    found = check("tiago", 50, 7, jobs=1)  # other tests run beside it
    assert found.ok_share >= 0.9999
    assert found.ee_error_rms <= 1e-5
    assert found.ee_error_max <= 1e-3
    assert found.orientation_error_max <= 1e-3
    assert found.joint_limit_violations == found.self_contacts == 0
    assert found.lateral_base_max == found.reach_base_path == 0.0
    assert found.out_l <= 3e-3
    assert found.out_psi <= 0.03
    assert found.out_z <= 1e-3
