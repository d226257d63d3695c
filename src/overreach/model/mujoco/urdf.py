"""URDF files as they are found: package:// paths, meshes of other kinds, inertias that are none. Repairs are told."""

from __future__ import annotations

import math
import os
import tempfile
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from overreach.errors import SetupError

MESHES = (".stl", ".obj", ".msh")
"""Kinds of meshes that MuJoCo reads."""
MOMENTS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
MOST_LINKS = 2000
HAIR = 1e-4
"""Way [rad, m] of a joint that is to have none."""
TOLD = 3
"""So many names are told of those that were repaired alike."""
FASTEST = 10.0
"""A joint speed [rad/s, m/s] above which the file is more likely wrong than the joint that fast."""


class Source(NamedTuple):
    """A model, to be compiled; a warning for each repair; the joints' speeds [rad/s, m/s] where the file gives them."""

    spec: mujoco.MjSpec
    warnings: list[str]
    speeds: dict[str, float]


def read_urdf(path: Path) -> Source:
    """Return the model in a URDF file; raises SetupError in one line."""
    try:
        tree = ET.parse(path)
    except (ET.ParseError, OSError, ValueError) as error:
        raise SetupError(f"the model file {str(path)!r} is no valid URDF: {error}") from None
    robot = tree.getroot()
    if robot.tag != "robot":
        raise SetupError(f"the model file {str(path)!r} is no URDF: its first element is <{robot.tag}>, not <robot>")
    if (many := len(robot.findall("link"))) > MOST_LINKS:
        raise SetupError(f"the model file {str(path)!r} has {many:,} links: at most {MOST_LINKS:,} are read")
    warnings: list[str] = []
    _check_names(robot, path)
    _check_loops(robot, path)
    dropped = _meshes(robot, path)
    if dropped:
        kinds = ", ".join(sorted({Path(name).suffix or name for name in dropped}))
        warnings.append(f"{len(dropped)} collision meshes cannot be read ({kinds}): they are left out")
    impossible = []
    for link in robot.iter("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
        if _inertia_is_left_out(link):
            impossible.append(link.get("name", ""))
    if impossible:
        warnings.append(f"{_many(impossible, 'link')} with a mass or inertia that no body can have: it is left out")
    still = [joint.get("name", "") for joint in robot.findall("joint") if _has_no_way(joint, path)]
    if still:
        warnings.append(f"{_many(still, 'joint')} with no way between the limits: given a hair's breadth")
    robot[:] = [element for element in robot if element.tag in ("link", "joint")]
    options = ET.SubElement(robot, "mujoco")
    ET.SubElement(
        options, "compiler", balanceinertia="true", discardvisual="true", fusestatic="false", strippath="false",
        boundmass="0.001", boundinertia="1e-6",
    )  # fmt: skip
    speeds = _speeds(robot)
    for name, speed in speeds.items():
        if speed > FASTEST:
            warnings.append(f"joint {name!r} is said to move at {speed:g}/s: taken as it stands; is it in degrees?")
    with tempfile.TemporaryDirectory() as folder:
        cleaned = os.path.join(folder, "robot.urdf")
        tree.write(cleaned)
        try:
            spec = mujoco.MjSpec.from_file(cleaned)
        except (ValueError, RuntimeError) as error:
            said = " ".join(str(error).split())
            raise SetupError(f"the model file {str(path)!r} cannot be used: {said}") from None
    return Source(spec, warnings, speeds)


def _check_names(robot: ET.Element, path: Path) -> None:
    for tag in ("link", "joint"):
        seen: set[str] = set()
        for element in robot.findall(tag):
            name = element.get("name", "")
            if not name or name in seen:
                what = f"two {tag}s are called {name!r}" if name else f"a {tag} has no name"
                raise SetupError(f"the model file {str(path)!r} cannot be used: {what}")
            seen.add(name)


def _check_loops(robot: ET.Element, path: Path) -> None:
    parents: dict[str, str] = {}
    links = {link.get("name", "") for link in robot.findall("link")}
    for joint in robot.findall("joint"):
        ends = [joint.find(tag) for tag in ("parent", "child")]
        parent, child = ["" if end is None else end.get("link", "") for end in ends]
        for end in (parent, child):
            if end not in links:
                raise SetupError(
                    f"the model file {str(path)!r} cannot be used: joint {joint.get('name')!r} names the link {end!r}, "
                    "which is not there"
                )
        if child in parents:
            raise SetupError(f"the model file {str(path)!r} cannot be used: the link {child!r} has two parents")
        parents[child] = parent
    for link in links:
        seen, at = {link}, link
        while at in parents:
            at = parents[at]
            if at in seen:
                raise SetupError(f"the model file {str(path)!r} cannot be used: its links form a loop at {at!r}")
            seen.add(at)


def _meshes(robot: ET.Element, path: Path) -> list[str]:
    """Give each collision mesh the path of its file; leave out those that cannot be read, and return their names."""
    dropped = []
    for link in robot.iter("link"):
        for collision in link.findall("collision"):
            mesh = collision.find("geometry/mesh")
            if mesh is None:
                continue
            name = mesh.get("filename", "")
            found = _resolved(name, path)
            if found is None or found.suffix.lower() not in MESHES:
                link.remove(collision)
                dropped.append(name)
            else:
                mesh.set("filename", str(found))
    return dropped


def _resolved(name: str, path: Path) -> Path | None:
    """Return the file of a mesh: package://NAME/... is looked for in the folders above, and where ROS looks."""
    for scheme in ("package://", "model://"):
        if name.startswith(scheme):
            rest = Path(name.removeprefix(scheme))
            if not rest.parts:
                return None
            places = [parent for above in path.resolve().parents for parent in (above, above / "..")]
            places += [Path(one) for one in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if one]
            places += [Path(one) / "share" for one in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if one]
            inside = Path(*rest.parts[1:])
            for place in places:
                if (place / rest).is_file():
                    return place / rest
                if place.name == rest.parts[0] and (place / inside).is_file():
                    return place / inside
            return None
    found = path.parent / name.removeprefix("file://")
    return found.resolve() if found.is_file() else None


def _many(names: list[str], what: str) -> str:
    """Return names in words, the first few of many."""
    more = f" and {len(names) - TOLD} more" if len(names) > TOLD else ""
    return f"{len(names)} {what}{'s' if len(names) > 1 else ''} ({', '.join(names[:TOLD])}{more})"


def _has_no_way(joint: ET.Element, path: Path) -> bool:
    """Give a joint whose limits leave it no way, as a gripper's often do, a little: else it would have no limits.

    Raises SetupError for limits in the wrong order.
    """
    limit = joint.find("limit")
    if joint.get("type") not in ("revolute", "prismatic") or limit is None:
        return False
    try:
        lower, upper = float(limit.get("lower", "0")), float(limit.get("upper", "0"))
    except ValueError:
        return False  # told by who reads it
    if lower > upper:
        raise SetupError(
            f"the model file {str(path)!r} cannot be used: the limits of joint {joint.get('name')!r} are {lower:g} and "
            f"{upper:g}, in the wrong order"
        )
    if lower < upper:
        return False
    limit.set("lower", repr(lower))
    limit.set("upper", repr(lower + HAIR))
    return True


def _inertia_is_left_out(link: ET.Element) -> bool:
    """Leave out an inertia that no body can have, and say so: MuJoCo then makes one of the geometry."""
    inertial = link.find("inertial")
    if inertial is None:
        return False
    mass, inertia = inertial.find("mass"), inertial.find("inertia")
    try:
        value = float("nan" if mass is None else mass.get("value", "nan"))
        xx, yy, zz, xy, xz, yz = [float("nan" if inertia is None else inertia.get(key, "0")) for key in MOMENTS]
    except ValueError:
        value = xx = yy = zz = xy = xz = yz = math.nan
    whole = np.array(((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)))
    if value > 0.0 and np.isfinite(whole).all() and float(np.linalg.eigvalsh(whole)[0]) > 0.0:
        return False
    link.remove(inertial)
    return True


def _speeds(robot: ET.Element) -> dict[str, float]:
    speeds = {}
    for joint in robot.findall("joint"):
        limit = joint.find("limit")
        if limit is not None and joint.get("type") in ("revolute", "continuous", "prismatic"):
            try:
                speed = float(limit.get("velocity", "0"))
            except ValueError:
                continue
            if speed > 0.0:
                speeds[joint.get("name", "")] = speed
    return speeds
