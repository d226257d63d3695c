"""A robot that is not built in: an arm of six joints, of the size of a UR5, on any base, with its shoulder anywhere."""

from __future__ import annotations

import math
from pathlib import Path

import mujoco

from overreach.model.mujoco.primitives import box, cylinder, hinge, limb, omni_wheel, wheel

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
UPPER, FORE, ASIDE, BACK, WRIST, LAST, TOOL = 0.425, 0.392, 0.136, 0.12, 0.093, 0.095, 0.2
"""Lengths [m]: of the upper arm and the forearm; the offsets at shoulder and elbow; of the wrists; to the tip."""
HOME = (0.0, -1.2, 1.9, -0.7, -math.pi / 2.0, 0.0)
"""Elbow up, the tool level and ahead."""


def spec(s_x: float, bolted: float = 0.0, omni: bool = False) -> mujoco.MjSpec:
    """Return the model, to be compiled: the shoulder s_x [m] ahead of the turning centre, turned by `bolted` [rad]."""
    made = mujoco.MjSpec()
    made.modelname = "ur5"
    made.compiler.degree = False
    base = made.worldbody.add_body(name="base")
    base.add_freejoint(name="free")
    box(base, (0.0, 0.0, 0.2), (0.35, 0.25, 0.15), 60.0)
    box(base, (s_x, 0.0, 0.42), (0.09, 0.09, 0.08), 6.0)
    for name, y in (("left", 0.27), ("right", -0.27)):
        if omni:
            for end, x in (("front", 0.25), ("rear", -0.25)):
                omni_wheel(base, f"{end}_{name}", (x, y, 0.1), 0.0, 0.1, 0.06)
        else:
            wheel(base, name, (0.0, y, 0.1), 0.1, 0.04, 1.5)
    turn = (math.cos(0.5 * bolted), 0.0, 0.0, math.sin(0.5 * bolted))
    pan = base.add_body(name="pan", pos=(s_x, 0.0, 0.5), quat=turn)
    hinge(pan, "pan", Z, -6.28, 6.28)
    cylinder(pan, (0.0, 0.0, 0.05), 0.06, 0.05, 3.7)
    lift = pan.add_body(name="lift", pos=(0.0, ASIDE, 0.089))
    hinge(lift, "lift", Y, -6.28, 6.28)
    limb(lift, (0.0, 0.0, 0.0), (UPPER, 0.0, 0.0), 0.055, 8.4)
    elbow = lift.add_body(name="elbow", pos=(UPPER, -BACK, 0.0))
    hinge(elbow, "elbow", Y, -3.1, 3.1)
    limb(elbow, (0.0, 0.0, 0.0), (FORE, 0.0, 0.0), 0.045, 2.3)
    one = elbow.add_body(name="wrist_1", pos=(FORE, WRIST, 0.0))
    hinge(one, "wrist_1", Y, -6.28, 6.28)
    limb(one, (0.0, -0.02, 0.0), (0.0, 0.02, 0.0), 0.04, 1.2)
    two = one.add_body(name="wrist_2")
    hinge(two, "wrist_2", Z, -6.28, 6.28)
    limb(two, (0.0, 0.0, 0.0), (0.0, 0.0, -LAST), 0.038, 1.2)
    three = two.add_body(name="wrist_3", pos=(0.0, 0.0, -LAST))
    hinge(three, "wrist_3", Y, -6.28, 6.28)
    limb(three, (0.0, 0.05, 0.0), (0.0, TOOL, 0.0), 0.03, 0.8)
    return made


def written(
    folder: Path, s_x: float, bolted: float = 0.0, omni: bool = False, yaw: float = 0.0,
    home: tuple[float, ...] = HOME, name: str = "ur5", heading: float = 0.0,
) -> str:  # fmt: skip
    """Write model and description into `folder`; return the description's path.

    yaw: [mount] yaw [rad]; heading: where the base drives to, as a yaw of its body [rad].
    """
    model = spec(s_x, bolted, omni)
    model.compile()
    (folder / "ur5.xml").write_text(model.to_xml(), "utf-8")
    wheels = (
        ["wheel_front_left", "wheel_rear_left", "wheel_front_right", "wheel_rear_right"]
        if omni else ["wheel_left", "wheel_right"]
    )  # fmt: skip
    path = folder / "ur5.toml"
    path.write_text(
        f"""\
name = "{name}"
model = "ur5.xml"
home = {[round(one, 6) for one in home]}
[base]
kind = "{"omni" if omni else "differential"}"
body = "base"
wheels = {wheels}
v_max = 1.0
w_max = 1.5
dv_max = 2.0
dw_max = 4.0
footprint = [0.7, 0.58]
heading = {heading}
[arm]
joints = ["pan", "lift", "elbow", "wrist_1", "wrist_2", "wrist_3"]
speed = [3.15, 3.15, 3.15, 3.2, 3.2, 3.2]
acceleration = [15.0, 15.0, 15.0, 20.0, 20.0, 20.0]
[hand]
body = "wrist_3"
offset = [0.0, {TOOL}, 0.0]
approach = [0.0, 1.0, 0.0]
[mount]
yaw = {yaw}
""",
        "utf-8",
    )
    return str(path)
