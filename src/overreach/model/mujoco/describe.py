"""A first description of a robot, from its model file alone. Each guess is marked as one."""

from __future__ import annotations

import os
from pathlib import Path

import mujoco

from overreach.files import write_text
from overreach.model.mujoco.guess import Guess, guess
from overreach.model.mujoco.source import compiled, spec_from_file

ACCELERATION = 8.0
"""Accelerations are guessed as this many times the speed [1/s^2 per 1/s]."""


def toml(
    found: Guess, name: str, model: str, home: tuple[float, ...], places: list[tuple[str, float]] | None = None
) -> str:
    """Return the description, with each guess marked. places: of the joints that are locked [m]."""
    places = places or []
    guessed = "# guessed: "
    speeds = ", ".join(f"{speed:g}" for speed, _ in found.speeds)
    unknown = [joint for joint, (_, known) in zip(found.joints, found.speeds, strict=True) if not known]
    note = f"   {guessed}the model has none for {', '.join(unknown)}: look them up" if unknown else ""
    wheels = ", ".join(f'"{wheel}"' for wheel in found.wheels)
    times = f"   {guessed}{ACCELERATION:g} times the speed"
    offset = ", ".join(f"{found.ahead * one + 0.0:g}" for one in found.approach)
    note = f"{guessed}slower than the hand is to go, and midway: where is it?"
    slow = "".join(f"\n[locked]\n{lift} = {at:g}   {note}\n" for lift, at in places)
    others = f"   # other chains end at {', '.join(found.chains)}" if found.chains else ""
    return f"""\
# A first description, from the model file alone. Look at every line that is marked as guessed.
name = "{name}"
summary = ""
model = "{model}"
home = [{", ".join(f"{one:g}" for one in home)}]   {guessed}`overreach workspace --find-home` looks for a better one

[base]
kind = "{found.kind}"   {guessed}"differential" drives and turns, "omni" moves sideways too
body = "{found.base}"
wheels = [{wheels}]
v_max = 0.5   {guessed}[m/s]
w_max = 1.0   {guessed}[rad/s]
dv_max = 1.0   {guessed}[m/s^2]
dw_max = 2.0   {guessed}[rad/s^2]
footprint = [{found.footprint[0]:g}, {found.footprint[1]:g}]   # length, width [m]

[arm]
joints = [{", ".join(f'"{joint}"' for joint in found.joints)}]{others}
speed = [{speeds}]{note}
acceleration = [{", ".join(f"{ACCELERATION * speed:g}" for speed, _ in found.speeds)}]{times}

[hand]
body = "{found.hand}"
offset = [{offset}]   {guessed}where the hand is, in this body [m]
approach = [{", ".join(f"{one:g}" for one in found.approach)}]   {guessed}where it points, in this body
gripper = [{", ".join(f'"{joint}"' for joint in found.gripper)}]
{slow}"""


def middle(model: mujoco.MjModel, joints: tuple[str, ...]) -> tuple[float, ...]:
    """Return the middle of each joint's range, 0 where it has none."""
    values = []
    for name in joints:
        j = model.joint(name).id
        low, high = model.jnt_range[j] if model.jnt_limited[j] else (0.0, 0.0)
        values.append(round(0.5 * float(low + high), 3) + 0.0)
    return tuple(values)


def describe(path: Path, named: str = "") -> tuple[str, list[str], list[str]]:
    """Return a first description of the robot in a model file, what was repaired, and the joints without a speed.

    named: the path by which the description is to name the file; by default as if it lay beside it. Raises SetupError.
    """
    source = spec_from_file(path)
    model = compiled(source.spec, f"the model file {str(path)!r}")
    found = guess(model, source.speeds, f"the model file {str(path)!r}")
    unknown = [joint for joint, (_, known) in zip(found.joints, found.speeds, strict=True) if not known]
    places = list(zip(found.locked, middle(model, found.locked), strict=True))
    text = toml(found, path.stem, named or path.name, middle(model, found.joints), places)
    return text, source.warnings, unknown


def run_describe(path: Path, out: Path | None) -> None:
    """Print the description, or write it; raises SetupError with nothing written."""
    text, warnings, _ = describe(path, Path(os.path.relpath(path, out.parent if out else Path())).as_posix())
    for warning in warnings:
        print(f"# warning: {warning}")
    print(text, end="")
    if out is not None:
        write_text(out, text)
