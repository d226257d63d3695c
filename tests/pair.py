"""A robot with two arms that is not built in: six joints each, side by side on one base, a lift below both."""

from __future__ import annotations

from pathlib import Path

import mujoco

from overreach.model.mujoco.primitives import box, hinge, limb, slide, wheel

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
APART, UPPER, FORE, WRIST, TOOL = 0.25, 0.35, 0.32, 0.08, 0.12
"""Lengths [m]: of a shoulder from the middle; upper arm, forearm, wrist, and to the tip."""
HOME = (0.0, -0.5, 1.5, 0.0, -1.0, 0.0)


def spec() -> mujoco.MjSpec:
    """Return the model, to be compiled."""
    made = mujoco.MjSpec()
    made.modelname = "pair"
    made.compiler.degree = False
    base = made.worldbody.add_body(name="base")
    base.add_freejoint(name="free")
    box(base, (0.0, 0.0, 0.2), (0.3, 0.25, 0.15), 60.0)
    for name, y in (("left", 0.27), ("right", -0.27)):
        wheel(base, name, (0.0, y, 0.1), 0.1, 0.04, 1.5)
    lift = base.add_body(name="lift", pos=(0.05, 0.0, 0.6))
    slide(lift, "lift", Z, 0.0, 0.3)
    box(lift, (0.0, 0.0, 0.0), (0.05, 0.12, 0.08), 6.0)
    for name, sign in (("left", 1.0), ("right", -1.0)):
        pan = lift.add_body(name=f"{name}_pan", pos=(0.05, sign * APART, 0.1))
        hinge(pan, f"{name}_pan", Z, -2.0, 2.0)
        box(pan, (0.0, 0.0, 0.0), (0.04, 0.04, 0.03), 1.0)
        shoulder = pan.add_body(name=f"{name}_shoulder", pos=(0.0, 0.0, 0.05))
        hinge(shoulder, f"{name}_shoulder", Y, -1.8, 1.8)
        limb(shoulder, (0.04, 0.0, 0.0), (UPPER, 0.0, 0.0), 0.04, 2.0)
        elbow = shoulder.add_body(name=f"{name}_elbow", pos=(UPPER, 0.0, 0.0))
        hinge(elbow, f"{name}_elbow", Y, -0.1, 2.8)
        limb(elbow, (0.04, 0.0, 0.0), (FORE, 0.0, 0.0), 0.035, 1.5)
        roll = elbow.add_body(name=f"{name}_roll", pos=(FORE, 0.0, 0.0))
        hinge(roll, f"{name}_roll", X, -2.9, 2.9)
        box(roll, (0.0, 0.0, 0.0), (0.02, 0.02, 0.02), 0.3)
        pitch = roll.add_body(name=f"{name}_pitch")
        hinge(pitch, f"{name}_pitch", Y, -2.0, 2.0)
        limb(pitch, (0.02, 0.0, 0.0), (WRIST, 0.0, 0.0), 0.03, 0.6)
        hand = pitch.add_body(name=f"{name}_hand", pos=(WRIST, 0.0, 0.0))
        hinge(hand, f"{name}_turn", Z, -2.9, 2.9)
        limb(hand, (0.02, 0.0, 0.0), (TOOL, 0.0, 0.0), 0.025, 0.4)
        finger = hand.add_body(name=f"{name}_finger", pos=(TOOL, 0.02, 0.0))
        slide(finger, f"{name}_finger", Y, 0.0, 0.04)
        box(finger, (0.02, 0.0, 0.0), (0.02, 0.005, 0.01), 0.05)
    return made


def hand_table(name: str, more: str = "") -> str:
    """Return the tables of a hand."""
    joints = ", ".join(f'"{name}_{part}"' for part in ("pan", "shoulder", "elbow", "roll", "pitch", "turn"))
    return f"""
[hands.{name}]
home = {list(HOME)}
{more}
[hands.{name}.arm]
joints = [{joints}]
speed = [3.0, 3.0, 3.0, 3.0, 3.0, 3.0]
acceleration = [15.0, 15.0, 15.0, 20.0, 20.0, 20.0]

[hands.{name}.hand]
body = "{name}_hand"
offset = [{TOOL}, 0.0, 0.0]
approach = [1.0, 0.0, 0.0]
gripper = ["{name}_finger"]
"""


BASE = """\
name = "pair"
model = "pair.xml"

[base]
kind = "differential"
body = "base"
wheels = ["wheel_left", "wheel_right"]
v_max = 0.8
w_max = 1.5
dv_max = 2.0
dw_max = 4.0
footprint = [0.6, 0.58]

[locked]
lift = 0.1
"""


def written(folder: Path) -> str:
    """Write model and description into `folder`; return the description's path."""
    model = spec()
    model.compile()
    (folder / "pair.xml").write_text(model.to_xml(), "utf-8")
    path = folder / "pair.toml"
    path.write_text(BASE + hand_table("left") + hand_table("right"), "utf-8")
    return str(path)
