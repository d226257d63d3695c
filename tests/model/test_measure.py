"""Workspaces: measured, refused where they would be of no use, shipped with the model that they are of, and kept."""

from __future__ import annotations

import json
import math
import tomllib
from itertools import product
from pathlib import Path

import msgspec
import mujoco
import numpy as np
import pytest

from overreach.arm.spatial import task
from overreach.arm.spatial.screws import Array
from overreach.errors import SetupError, WorkspaceError
from overreach.model import catalogue
from overreach.model.cache import keep, kept
from overreach.model.catalogue import described, description_of, measured, parts_in, robot_of, workspace_of
from overreach.model.description import MODES, read_description
from overreach.model.measure.box import largest
from overreach.model.measure.command import run_workspace
from overreach.model.measure.measure import Result
from overreach.model.measure.rank import holds, sentence
from overreach.model.measure.text import drawing, table, with_table
from overreach.model.mujoco.contact import Contacts
from overreach.model.mujoco.robot import Parts, parts_of

OURS = ("mobile7", "mobile4", "omni7", "omni5")


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


def parts(name: str, mode: str = "follow", home: tuple[float, ...] = ()) -> Parts:
    description, folder = description_of(name)
    if home:
        description = msgspec.structs.replace(description, home=home, homes={})
    return parts_in(description, folder, mode)


@pytest.mark.parametrize("name", OURS)
def test_what_ships_is_what_is_measured(name: str) -> None:
    """The tables in the wheel are of the models in it, and measuring again gives the same numbers."""
    found = parts(name)
    shipped = found.description.workspace["follow"]
    again = measured(found).measured
    assert shipped == again
    assert workspace_of(found, "follow", pytest.fail) == shipped


def test_a_home_below_the_ground_is_refused() -> None:
    """The hand cannot be there: said, with how far, and never chosen as a home."""
    low = parts("mobile4", home=(0.0, 0.2, 1.2, -0.5))
    assert low.arm.posture_at_home.z < -0.01
    with pytest.raises(WorkspaceError, match=r"at home the hand is 0\.\d\d\d m below the ground"):
        measured(low)


def test_every_shipped_table_is_of_its_model() -> None:
    """Each of our robots has its usual mode measured, with the hash of the model that ships."""
    for name in OURS:
        description, folder = description_of(name)
        for mode, table_ in description.workspace.items():
            assert parts_of(description.in_mode(mode), folder).key == table_.model, (name, mode)
        assert "follow" in description.workspace


def test_every_posture_of_a_sector_is_one_that_the_arm_can_have() -> None:
    """All over the sector: the hand is there, off its limits, not singular, not touching, and near its neighbours."""
    found = parts("mobile4")
    result = measured(found)
    box, walked = result.box, result.walked
    inside = tuple(slice(a, b + 1) for a, b in box[:3])
    contacts, channels = found.contacts(), found.arm.channels
    q = walked.q[inside].reshape(-1, len(channels))
    l, psi, z = [
        axis.ravel()
        for axis in np.meshgrid(*[axis[part] for axis, part in zip(walked[:3], inside, strict=True)], indexing="ij")
    ]
    _, p, _ = found.arm.posture_at_home.forward(q)
    R = found.arm.manner.reach
    assert np.abs(np.hypot(p[:, 0], p[:, 1]) - l).max() < 0.0022 * R
    assert np.abs(np.arctan2(p[:, 1], p[:, 0]) - psi).max() < 0.02
    assert np.abs(p[:, 2] - z).max() < 0.0022 * R
    assert walked.sigma[inside].min() >= found.arm.manner.sigma
    for joints in q:
        assert not contacts.touching(joints)
        assert all(
            c.lower + 0.03 - 1e-9 <= one <= c.upper - 0.03 + 1e-9 for one, c in zip(joints, channels, strict=True)
        )
    for axis in range(3):
        assert np.abs(np.diff(walked.q[inside], axis=axis)).max() < 0.6


def test_the_largest_box_is_the_largest() -> None:
    """By trying every box about home in small random grids."""
    random = np.random.default_rng(0)
    l, psi, z = 0.3 + 0.1 * np.arange(5), -0.2 + 0.1 * np.arange(5), 0.1 * np.arange(5)
    for _ in range(60):
        ok = random.random((5, 5, 5)) < 0.85
        home = (2, 2, 2)
        ok[home] = True
        best = 0.0
        for i_a in range(3):
            for i_b in range(2, 5):
                for j_a in range(3):
                    for j_b in range(2, 5):
                        for k_a in range(3):
                            for k_b in range(2, 5):
                                if k_b - k_a >= 2 and ok[i_a : i_b + 1, j_a : j_b + 1, k_a : k_b + 1].all():
                                    area = 0.5 * (l[i_b] ** 2 - l[i_a] ** 2) * (psi[j_b] - psi[j_a])
                                    best = max(best, area * (z[k_b] - z[k_a]))
        found = largest(ok, l, psi, z, home)
        assert (found.volume if found else 0.0) == pytest.approx(best)


def test_refusals() -> None:
    """A home beside the base, one in contact, one at a singularity, and a mode without a yaw: each says why."""
    with pytest.raises(WorkspaceError, match="home is beside the base"):
        measured(parts("mobile7", home=(0.2, 1.5, -0.25, 0.0, 1.55, 0.0, -1.3, 0.0)))
    with pytest.raises(WorkspaceError, match=r"touches its own robot: .*hand"):
        measured(parts("mobile7", home=(0.2, 0.0, 1.5, 0.0, 2.5, 0.0, 0.0, 0.0)))
    with pytest.raises(WorkspaceError, match="singular"):
        measured(parts("mobile4", home=(0.0, 0.0, 0.0, 0.0)))
    with pytest.raises(WorkspaceError, match='"fixed" needs a yaw'):
        parts("mobile4", "fixed")
    with pytest.raises(SetupError, match="outside its limits"):
        parts("mobile4", home=(3.0, 0.0, 1.0, 0.0))


def test_what_an_arm_can_hold() -> None:
    """Seven joints hold all; four hold the pitch, and the yaw follows."""
    assert holds(parts("mobile7").arm) == task.WHOLE
    assert holds(parts("mobile4").arm) == task.PITCH
    assert sentence(task.PITCH, 0.0) == "pitch held, yaw follows"


def test_kept_and_measured_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A workspace that is not known, or is of another model, is measured once, with one line, and kept."""
    found = parts("mobile4")
    asked: list[Parts] = []

    def counted(one: Parts) -> Result:
        asked.append(one)
        return measured(one)

    monkeypatch.setattr(catalogue, "measured", counted)
    strange = msgspec.structs.replace(found.description.workspace["follow"], model="0" * 16)
    for table_, why in ((None, "has none"), (strange, "of another model")):
        description = msgspec.structs.replace(found.description, workspace={"follow": table_} if table_ else {})
        said: list[str] = []
        first = workspace_of(found._replace(description=description), "follow", said.append)
        assert (why in said[0]) if not asked[1:] and table_ is None else not said
        assert first == kept(found.key, "follow")
    assert len(asked) == 1


def test_a_broken_cache_is_measured_anew(tmp_path: Path) -> None:
    """What cannot be read as a workspace is as if it were not there."""
    found = parts("mobile4").description.workspace["follow"]
    keep(found, "follow")
    (file,) = (tmp_path / "overreach" / "workspaces").iterdir()
    assert kept(found.model, "follow") == found
    file.write_bytes(file.read_bytes()[:-20])
    assert kept(found.model, "follow") is None


def test_the_table_is_the_description_s() -> None:
    """What is printed can be read; in a description it takes the place of the one before, and leaves the rest."""
    found = parts("mobile4")
    shipped = found.description.workspace["follow"]
    text = described()["mobile4"]
    other = msgspec.structs.replace(shipped, sigma=0.123)
    changed = with_table(text, other, "follow")
    read = read_description(changed)
    assert read.workspace == {**found.description.workspace, "follow": other}
    assert msgspec.structs.replace(read, workspace={}) == msgspec.structs.replace(found.description, workspace={})
    assert table(shipped, "follow") in with_table(changed, shipped, "follow")


def test_a_table_is_replaced_however_it_was_written() -> None:
    """With a remark behind its name, or spaces in it; what stands behind it stays, remarks as well."""
    found = parts("mobile4").description.workspace["follow"]
    rest = "# not ours\n\n# of the hand\n[hand]\nbody = 'x'\n"
    text = f"[ workspace.follow ]  # by hand\nl = [0.1, 0.2]\n{rest}"
    assert with_table(text, found, "follow") == f"{table(found, 'follow')}{rest}"
    assert with_table(rest, found, "follow") == f"{rest}\n{table(found, 'follow')}"
    twice = with_table(with_table(f"{rest}\n\n", found, "follow"), found, "fixed")
    assert with_table(twice, found, "follow") == twice
    assert with_table("[workspace.follow]\n[hand]\n", found, "follow") == f"{table(found, 'follow')}\n[hand]\n"
    with pytest.raises(SetupError, match=r"\[workspace.follow\] cannot be put"):
        with_table("workspace = 3\n", found, "follow")


def test_what_touches_is_as_near_as_is_said() -> None:
    """Bodies that are said to be too close are so, by MuJoCo's distance of their geoms; the model stays as it was."""
    found = parts("mobile7")
    distance = 0.05
    margins = found.model.geom_margin.copy()
    contacts = Contacts(found.model, found.description, distance)
    assert (found.model.geom_margin == margins).all()
    random, told = np.random.default_rng(5), 0
    data = mujoco.MjData(found.model)
    lower, upper = found.arm.limits[:, 0], found.arm.limits[:, 1]
    for q in random.uniform(np.maximum(lower, -2.0), np.minimum(upper, 2.0), (60, len(lower))):
        for channel, at in zip(found.arm.channels, q, strict=True):
            data.joint(channel.moves).qpos[0] = at
        mujoco.mj_kinematics(found.model, data)
        for pair in contacts.touching(q):
            geoms = [np.flatnonzero(found.model.geom_bodyid == body) for body in pair]
            apart = min(mujoco.mj_geomDistance(found.model, data, a, b, 1.0, None) for a in geoms[0] for b in geoms[1])
            assert apart <= distance + 1e-6
            told += 1
    assert told > 10


def test_what_is_close_at_home_keeps_half_of_that() -> None:
    """A pair that is within the distance at home may be so elsewhere, down to half of what lies between them there."""
    found = parts("mobile7")
    whole, half = [Contacts(found.model, found.description, 0.1, part) for part in (1.0, 0.5)]
    lower, upper = found.arm.limits[:, 0], found.arm.limits[:, 1]
    random, data = np.random.default_rng(6), mujoco.MjData(found.model)
    at_home = np.array(found.arm.home)

    def apart(q: Array, pair: tuple[int, int]) -> float:
        for channel, at in zip(found.arm.channels, q, strict=True):
            data.joint(channel.moves).qpos[0] = at
        mujoco.mj_kinematics(found.model, data)
        geoms = [np.flatnonzero(found.model.geom_bodyid == body) for body in pair]
        return float(min(mujoco.mj_geomDistance(found.model, data, *ab, 5.0, None) for ab in product(*geoms)))

    assert not whole.touching(at_home)
    told, quiet = 0, 0
    for q in random.uniform(lower, upper, (200, len(lower))):
        seen = whole.touching(q)
        assert half.touching(q) <= seen
        for pair in seen:
            assert apart(q, pair) <= 1.05 * min(0.1, 0.5 * apart(at_home, pair))  # MuJoCo's two ways differ
        for pair in half.touching(q):
            assert apart(q, pair) <= 1.05 * min(0.05, 0.25 * apart(at_home, pair))
        told += bool(seen)
        quiet += not seen
    assert told > 10
    assert quiet > 10


def test_a_home_that_was_found_has_its_own_hash(capsys: pytest.CaptureFixture[str]) -> None:
    """The table that is printed for a home that was looked for is that of the description with this home in it."""
    run_workspace("mobile4", "", find_home=True, out=None, figure=None)
    said = capsys.readouterr().out
    home = tuple(json.loads(said.rsplit("\nhome = ", 1)[1].split("\n")[0]))
    printed = tomllib.loads(said[said.index("[workspace.follow]") :])["workspace"]["follow"]
    there = parts("mobile4", home=home)
    assert printed["model"] == there.key
    assert printed["l"] == list(measured(there).measured.l)


def test_the_drawing_has_the_sector() -> None:
    """From above and from the side, as many columns as there are lengths, with the sector in it."""
    result = measured(parts("mobile4"))
    text = drawing(result)
    columns = len(result.walked.l)
    rows = [line[8:] for line in text.splitlines() if set(line[8:]) <= set("#+.") and len(line) == 8 + columns]
    wide, high = result.box.psi[1] - result.box.psi[0] + 1, result.box.z[1] - result.box.z[0] + 1
    assert sum("#" in row for row in rows) == wide + high


def test_a_robot_is_what_its_description_says() -> None:
    """Limits, workspace and command of a robot are those of its description, its hand starts inside."""
    found = parts("mobile7")
    model = robot_of(found, "follow", found.description.workspace["follow"])
    space, start = model.workspace, model.start
    assert (space.l_min, space.l_max) == found.description.workspace["follow"].l
    assert space.edges
    assert space.contains(start.l, start.psi)
    chain = model.arm.at(model.arm.posture(start.l, start.psi), model.mount)
    assert (chain.l, chain.psi) == pytest.approx((start.l, start.psi), abs=1e-6)
    assert space.z_min < chain.hand[2] < space.z_max
    with pytest.raises(WorkspaceError, match="inside the measured one"):
        model.placed(model.mount, msgspec.structs.replace(space, l_max=space.l_max + 0.01))
    assert math.isclose(model.placed(model.mount, space).workspace.l_max, space.l_max)
    assert set(found.description.workspace) <= set(MODES)
