"""Model files as people have them: what can be mended is, and told; of the rest one line says what is wrong."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from overreach.errors import SetupError
from overreach.model.description import Description, read_description
from overreach.model.mujoco.describe import describe, run_describe
from overreach.model.mujoco.robot import parts_of
from overreach.model.mujoco.source import compiled, spec_from_file

INERTIAL = """<inertial><mass value="{mass}"/>
  <inertia ixx="{inertia}" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>"""
BASE = f"""
<link name="base_link">{INERTIAL.format(mass=10, inertia=0.02)}
  <collision><geometry><box size="0.4 0.4 0.2"/></geometry></collision></link>
"""
JOINT = """
<link name="{name}_link">{inertial}
  <visual><geometry><mesh filename="package://my_robot/meshes/{name}.dae"/></geometry></visual>
  <collision><origin xyz="0.1 0 0" rpy="0 1.5708 0"/>
    <geometry><cylinder radius="0.03" length="0.15"/></geometry></collision></link>
<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{name}_link"/>
  <origin xyz="{at}"/><axis xyz="{axis}"/>
  <limit lower="-2.0" upper="2.0" effort="10" velocity="{velocity}"/></joint>
"""
HAND = """
<link name="hand_link"/>
<joint name="to_hand" type="fixed"><parent link="{parent}"/><child link="hand_link"/><origin xyz="0.1 0 0"/></joint>
"""
WHEEL = """
<link name="{side}_wheel">{inertial}
  <collision><origin rpy="1.5708 0 0" xyz="0 0 0"/>
    <geometry><cylinder radius="0.1" length="0.04"/></geometry></collision></link>
<joint name="{side}_wheel_joint" type="continuous"><parent link="base_link"/><child link="{side}_wheel"/>
  <origin xyz="0 {y} 0.1"/><axis xyz="0 1 0"/></joint>
"""
FIXED = '<joint name="{name}" type="fixed"><parent link="{parent}"/><child link="{child}"/></joint>'
SHELL = """
<link name="shell"><collision><geometry><mesh filename="package://my_robot/{file}"/></geometry></collision></link>
<joint name="to_shell" type="fixed"><parent link="base_link"/><child link="shell"/></joint>
"""


def urdf(velocity: str = "2.0", inertia: str = "0.01", extra: str = "") -> str:
    """Return a robot with a base, two wheels, five joints and a hand."""
    text, parent = BASE, "base_link"
    for k, axis in enumerate(("0 0 1", "0 1 0", "0 1 0", "0 1 0", "1 0 0"), start=1):
        at = "0.1 0 0.3" if k == 1 else "0.02 0 0.1" if k == 2 else "0.25 0 0"
        own = INERTIAL.format(mass=1, inertia=inertia)
        text += JOINT.format(name=f"arm_{k}", inertial=own, parent=parent, at=at, axis=axis, velocity=velocity)
        parent = f"arm_{k}_link"
    text += HAND.format(parent=parent)
    for side, y in (("left", "0.2"), ("right", "-0.2")):
        text += WHEEL.format(side=side, y=y, inertial=INERTIAL.format(mass=0.5, inertia=0.01))
    return f'<?xml version="1.0"?>\n<robot name="mine">{text}{extra}</robot>\n'


def written(tmp_path: Path, text: str, name: str = "robot.urdf") -> Path:
    path = tmp_path / name
    path.write_text(text)
    return path


def test_a_plain_urdf_is_described(tmp_path: Path) -> None:
    """Base, wheels, the arm's joints in order, their speeds and the hand are found; guesses are marked as such."""
    text, warnings, _ = describe(written(tmp_path, urdf()))
    found = read_description(text)
    assert found.base.body == "base_link"
    assert found.base.wheels == ("left_wheel_joint", "right_wheel_joint")
    assert [group[0] for group in found.arm.groups] == [f"arm_{k}" for k in range(1, 6)]
    assert found.arm.speed == (2.0,) * 5
    assert found.hand.body == "arm_5_link"
    assert text.count("guessed") > 5
    assert warnings == []
    parts = parts_of(found, tmp_path)
    assert parts.mount.s_x == pytest.approx(0.1)
    assert 0.5 < parts.arm.manner.reach < 1.2


NO_WAY = """<link name="finger_link"/><joint name="finger" type="revolute"><parent link="{parent}"/>
<child link="finger_link"/><axis xyz="0 0 1"/><limit lower="0" upper="0" effort="0" velocity="0"/></joint>"""


def test_repairs_are_told(tmp_path: Path) -> None:
    """Meshes that MuJoCo does not read are left out, impossible inertias too, and ranges that are none: a line each."""
    mesh, finger = SHELL.format(file="shell.dae"), NO_WAY.format(parent="arm_5_link")
    source = spec_from_file(written(tmp_path, urdf(inertia="-0.01", extra=mesh + finger)))
    assert [line.partition(" (")[0] for line in source.warnings] == [
        "1 collision meshes cannot be read", "5 links", "1 joint",
    ]  # fmt: skip
    assert "and 2 more) with a mass or inertia that no body can have" in source.warnings[1]
    model = compiled(source.spec, "it")
    assert model.njnt == 8
    assert np.ptp(model.jnt_range[model.joint("finger").id]) < 1e-3


LIFT = """<link name="lift_link"/><joint name="lift" type="prismatic"><parent link="base_link"/>
<child link="lift_link"/><origin xyz="0.1 0 0.2"/><axis xyz="0 0 1"/>
<limit lower="0" upper="0.4" effort="10" velocity="{speed}"/></joint>"""
FINGER = """<link name="{name}_link"/><joint name="{name}" type="revolute"><parent link="arm_5_link"/>
<child link="{name}_link"/><origin xyz="0.15 {y} 0"/><axis xyz="0 0 1"/>
<limit lower="0" upper="1" effort="10" velocity="2"/></joint><link name="{name}_2_link"/>
<joint name="{name}_2" type="revolute"><parent link="{name}_link"/><child link="{name}_2_link"/>
<origin xyz="0.05 0 0"/><axis xyz="0 0 1"/><limit lower="0" upper="1" effort="10" velocity="2"/></joint>"""
FOOT = FIXED.format(name="to_base", parent="base_footprint", child="base_link").replace(
    "/>", '/><origin xyz="0 0 0.08"/>', 1
)
SPRING = """<link name="{side}_spring"/><joint name="{side}_spring_joint" type="prismatic"><parent link="base_link"/>
<child link="{side}_spring"/><axis xyz="0 0 1"/><limit lower="0" upper="0.01" effort="10" velocity="1"/></joint>"""


def described(tmp_path: Path, text: str) -> Description:
    return read_description(describe(written(tmp_path, text))[0])


@pytest.mark.parametrize("speed", ["0.035", "0.15"])
def test_a_lift_slower_than_the_hand_is_locked(speed: str, tmp_path: Path) -> None:
    """It is put where the middle of its range is, and is no joint of the arm; a quicker one is."""
    text = urdf(extra=LIFT.format(speed=speed)).replace(
        'name="arm_1" type="revolute"><parent link="base_link"/>',
        'name="arm_1" type="revolute"><parent link="lift_link"/>',
    )
    found = described(tmp_path, text)
    slow = float(speed) < 0.08
    assert found.locked == ({"lift": 0.2} if slow else {})
    assert len(found.arm.joints) == (5 if slow else 6)
    parts_of(found, tmp_path)


def test_a_hand_of_many_fingers_is_no_part_of_the_arm(tmp_path: Path) -> None:
    """The arm ends where it branches; the hand is as far out as the fingers begin, which are its gripper."""
    fingers = "".join(FINGER.format(name=f"digit_{k}", y=0.03 * (k - 1)) for k in range(3))
    found = described(tmp_path, urdf(extra=fingers))
    assert found.arm.joints == ("arm_1", "arm_2", "arm_3", "arm_4", "arm_5")
    assert found.hand.body == "arm_5_link"
    assert found.hand.approach == (1.0, 0.0, 0.0)
    assert found.hand.offset == pytest.approx((0.175, 0.0, 0.0))
    assert len(found.hand.gripper) == 6


def test_the_base_is_the_frame_on_the_ground(tmp_path: Path) -> None:
    """A footprint that carries the base is it, and the wheels stand on its ground; one that it carries is not."""
    above = described(tmp_path, urdf(extra='<link name="base_footprint"/>' + FOOT))
    assert above.base.body == "base_footprint"
    assert above.base.footprint == (0.4, 0.4)
    below = FIXED.format(name="to_foot", parent="base_link", child="base_footprint")
    assert described(tmp_path, urdf(extra='<link name="base_footprint"/>' + below)).base.body == "base_link"


def test_wheels_on_a_suspension_are_found(tmp_path: Path) -> None:
    """A slide between base and wheel is no hindrance."""
    text = urdf(extra="".join(SPRING.format(side=side) for side in ("left", "right")))
    for side in ("left", "right"):
        text = text.replace(
            f'type="continuous"><parent link="base_link"/><child link="{side}_wheel"/>',
            f'type="continuous"><parent link="{side}_spring"/><child link="{side}_wheel"/>',
        )
    assert described(tmp_path, text).base.wheels == ("left_wheel_joint", "right_wheel_joint")


def test_an_inertia_that_is_not_positive_is_left_out(tmp_path: Path) -> None:
    """Moments that are each positive may still be those of no body: the products tell."""
    text = urdf().replace('iyy="0.01" izz="0.01" ixy="0"', 'iyy="0.01" izz="0.01" ixy="0.05"', 1)
    source = spec_from_file(written(tmp_path, text))
    assert ["1 link (base_link)" in line for line in source.warnings] == [True]
    compiled(source.spec, "it")


def test_a_description_names_its_model_from_where_it_lies(tmp_path: Path) -> None:
    """Written to another folder, a description names the model by the way from there, and is read from there."""
    model, out = written(tmp_path, urdf()), tmp_path / "mine" / "robot.toml"
    out.parent.mkdir()
    run_describe(model, out)
    description = read_description(out.read_text())
    assert description.model == f"../{model.name}"
    assert parts_of(description, out.parent).arm.channels


def test_packages_are_looked_for_in_the_folders_above(tmp_path: Path) -> None:
    """package://NAME/... is found beside the file's own package, as ROS workspaces lie."""
    package = tmp_path / "my_robot"
    (package / "meshes").mkdir(parents=True)
    (package / "urdf").mkdir()
    (package / "meshes" / "shell.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"
    )
    mesh = SHELL.format(file="meshes/shell.obj")
    path = package / "urdf" / "robot.urdf"
    path.write_text(urdf(extra=mesh))
    source = spec_from_file(path)
    assert source.warnings == []
    assert compiled(source.spec, "it").nmesh == 1


BAD = {
    "limits": (urdf().replace('lower="-2.0" upper="2.0"', 'lower="2.0" upper="-2.0"', 1), "in the wrong order"),
    "truncated": (urdf()[:900], "no valid URDF"),
    "empty": ("", "no valid URDF"),
    "two names": (urdf(extra='<link name="arm_1_link"/>'), "two links are called 'arm_1_link'"),
    "a loop": (urdf(extra=FIXED.format(name="x", parent="arm_5_link", child="base_link")), "loop"),
    "two parents": (urdf(extra=FIXED.format(name="x", parent="base_link", child="arm_3_link")), "two parents"),
    "no such link": (urdf(extra=FIXED.format(name="x", parent="nowhere", child="arm_3_link")), "not there"),
    "no arm": ('<robot name="r"><link name="base_link"/></robot>', "no base"),
    "too many links": (urdf(extra="".join(f'<link name="more_{k}"/>' for k in range(2000))), "2,009 links"),
    "text": ("hello\n", "no valid URDF"),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_files_are_one_line(what: str, tmp_path: Path) -> None:
    """Exit code 2, one line that says what is wrong, and nothing written."""
    text, said = BAD[what]
    path, out = written(tmp_path, text), tmp_path / "out.toml"
    ended = subprocess.run(  # noqa: PLW1510  the exit code is what is looked at
        [sys.executable, "-m", "overreach", "describe", str(path), "--out", str(out)],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert ended.returncode == 2, ended.stderr
    lines = ended.stderr.strip().splitlines()
    assert len(lines) == 1, lines
    assert said in lines[0]
    assert ended.stdout == ""
    assert not out.exists()


def test_a_huge_file(tmp_path: Path) -> None:
    """A URDF of 40 MB is read, or refused, in seconds, not held on to."""
    many = "".join(f'<material name="m{k}"><color rgba="0 0 0 1"/></material>' for k in range(700_000))
    path = written(tmp_path, urdf(extra=many))
    assert path.stat().st_size > 38e6
    begun = time.monotonic()
    text, *_ = describe(path)
    assert read_description(text).base.body == "base_link"
    assert time.monotonic() - begun < 60.0


def test_a_model_in_millimetres_looks_wrong(tmp_path: Path) -> None:
    """A reach of hundreds of metres, or speeds in degrees, are pointed at."""
    from overreach.check.found import looks_wrong

    text = urdf(velocity="120")
    for small in ("0.25 0 0", "0.02 0 0.1", "0.1 0 0.3"):
        text = text.replace(
            f'xyz="{small}"', 'xyz="' + " ".join(f"{1000 * float(one):g}" for one in small.split()) + '"'
        )
    described, warnings, _ = describe(written(tmp_path, text))
    assert sum("in degrees" in line for line in warnings) == 5
    parts = parts_of(read_description(described), tmp_path)
    lines = "\n".join(looks_wrong(parts))
    assert "other units" in lines
    assert "120 rad/s" in lines


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("speed = [2, 2, 2, 2, 2]|speed = [2, 0, 2, 2, 2]", "arm.speed must be a number > 0"),
        ('joints = ["arm_1", |joints = ["arm_9", ', "has no joint 'arm_9'"),
        ('body = "base_link"|body = "nothing"', "base.body: the model has no body 'nothing'"),
        ('kind = "differential"|kind = "legs"', "base.kind"),
        ("[hand]|[hnad]", "unknown"),
        ('joints = ["arm_1", "arm_2", |joints = ["arm_2", "arm_1", ', "from the base outward: arm_1, arm_2"),
        ('joints = ["arm_1", |joints = ["arm_2", ', "each once, from the base outward"),
        ('joints = ["arm_1", |joints = ["left_wheel_joint", ', "'left_wheel_joint' does not carry the hand"),
        ("approach = [1, 0, 0]|approach = [0, 0, 0]", "must be an axis"),
    ],
)
def test_bad_descriptions_say_what(change: str, said: str, tmp_path: Path) -> None:
    """What is wrong in a description is said with its key."""
    text, *_ = describe(written(tmp_path, urdf()))
    old, new = change.split("|")
    assert old in text
    with pytest.raises(SetupError, match=said):
        parts_of(read_description(text.replace(old, new)), tmp_path)
