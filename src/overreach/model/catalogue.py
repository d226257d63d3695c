"""Robots by name or by file: a description that ships, a TOML of the user's own, or a model file."""

from __future__ import annotations

import importlib.resources
import sys
from collections.abc import Callable
from functools import cache
from importlib.metadata import entry_points
from pathlib import Path

import msgspec

from overreach.errors import SetupError, UnknownNameError, WorkspaceError
from overreach.gate.limits import Limits
from overreach.model.cache import keep, kept
from overreach.model.described import DescribedRobot
from overreach.model.description import CommandTable, Description, Measured, check_mode, read_description
from overreach.model.guessed import guessed, homed
from overreach.model.handed import HandedRobot, hands_of
from overreach.model.measure.measure import SHARE_UP, TURN, Result, expected_speed, fastest, manner_for, measure
from overreach.model.measure.rank import WORDS
from overreach.model.model import Model
from overreach.model.mujoco.robot import Parts, parts_of
from overreach.model.workspace import Workspace

HAND = "@"
"""Between a robot and the hand that is driven, of one that has several, where both are one text."""
IN_MODE = "#"
"""Between a robot and the mode in which its hand is held, where both are one text."""
RAMP = 4.0
"""The command reaches full deflection in 1/RAMP s."""
FASTEST = 0.3
"""A robot whose description does not say more is driven at most this fast [m/s]."""
PLANAR = "overreach.models"
"""Entry points of robots that are made by code, not described."""
MODEL_FILES = (".xml", ".mjcf", ".urdf")


def described() -> dict[str, str]:
    """Return the robots that ship with a description and a model file: name -> TOML text."""
    folder = importlib.resources.files("overreach.model").joinpath("data")
    found = {entry.name.removesuffix(".toml"): entry.read_text("utf-8") for entry in folder.iterdir()}
    return {name: text for name, text in sorted(found.items()) if "\nmodel = " in text}


def is_file(which: str) -> bool:
    """Say whether a robot is named by a file: a TOML or a model."""
    return handless(which)[0].endswith((".toml", *MODEL_FILES))


def handless(which: str) -> tuple[str, str]:
    """Return a robot's name or file without the hand that is named behind it, and that hand, if any."""
    name, mark, hand = which.rpartition(HAND)
    return (name, hand) if mark and hand.isidentifier() else (which, "")


def description_of(which: str) -> tuple[Description, Path]:
    """Return the description called `which`, or in the TOML file `which`, and the folder where its paths begin.

    "@HAND" at its end says which of its hands is driven. Raises SetupError in one line.
    """
    which, hand = handless(which)
    if not is_file(which):
        texts = described()
        if which not in texts and entry_points(group=PLANAR, name=which):
            raise SetupError(
                f"{which!r} moves in the plane and has no model file: this is for robots in space, such as "
                f"{', '.join(texts)}"
            )
        if which not in texts:
            raise UnknownNameError("robot", which, texts)
        return read_description(texts[which], f"robot {which!r}", hand), Path()
    path = Path(which)
    if path.suffix != ".toml":
        if hand:
            raise SetupError(f"the model file {which!r} is guessed to have one hand: name those of it in a description")
        return guessed(path, _say), path.parent
    try:
        return read_description(path.read_text("utf-8"), f"robot description {which!r}", hand), path.parent
    except (OSError, UnicodeDecodeError) as error:
        raise SetupError(f"cannot read the robot description {which!r}: {error}") from None


def parts_in(description: Description, folder: Path, mode: str) -> Parts:
    """Return the parts of a robot with its hand held in `mode`; raises SetupError."""
    check_mode(mode)
    parts = parts_of(description.in_mode(mode), folder)
    table = description.command
    v = expected_speed(parts.arm.manner.reach, parts.base) if table is None else table.v
    return parts._replace(arm=parts.arm.held(manner_for(parts.arm, mode, v)))


def parted(which: str, mode: str = "") -> tuple[str, str]:
    """Return a robot's name or file, and how its hand is to be held: `mode`, what stands in the text, or neither."""
    name, _, own = which.partition(IN_MODE)
    return name, mode or own


def parts_for(which: str, mode: str = "") -> Parts:
    """Return the parts of the robot called `which`, or in the file `which`; a model file's home is looked for first."""
    name, mode = parted(which, mode)
    description, folder = description_of(name)
    mode = mode or description.mode
    if name.endswith(MODEL_FILES):
        description = homed(description, folder, mode, _say)
    return parts_in(description, folder, mode)


def workspace_of(parts: Parts, mode: str, say: Callable[[str], None]) -> Measured:
    """Return the workspace of a robot: as described if that was measured with this model, else kept, else measured."""
    shipped = parts.description.workspace.get(mode)
    if shipped is not None and shipped.model == parts.key:
        return shipped
    found = kept(parts.key, mode)
    if found is None:
        name = parts.description.name
        why = "its description has none" if shipped is None else "the one described is of another model"
        say(f"measuring the workspace of {name} ({mode}): {why}; kept for next time")
        found = measured(parts).measured
        keep(found, mode)
    return found


def measured(parts: Parts, progress: Callable[[int], None] = lambda _: None) -> Result:
    """Return the measurement of a robot's workspace; raises WorkspaceError with the reason."""
    return measure(parts.arm, parts.mount, parts.contacts(), parts.key, 1.0, progress, parts.base)


def _say(line: str) -> None:
    print(f"overreach: {line}", file=sys.stderr, flush=True)


def command_of(table: CommandTable | None, most: float) -> Limits:
    """Return full deflection and its ramps: as described, else by the rule, at most `most` [m/s]."""
    if table is not None:
        return Limits(table.v, table.w, table.dv, table.dw, table.v_z, table.dv_z)
    v = round(min(most, FASTEST), 3)
    up = round(SHARE_UP * v, 3)
    return Limits(v, TURN, RAMP * v, RAMP * TURN, up, RAMP * up)


def robot_of(parts: Parts, mode: str, found: Measured) -> DescribedRobot:
    """Return the robot with its workspace."""
    held = sum(row for row, word in WORDS.items() if word in found.held)
    if held != parts.arm.manner.held:
        raise WorkspaceError(f"[workspace.{mode}] holds {', '.join(found.held)}, which is not what the arm can hold")
    manner = msgspec.structs.replace(parts.arm.manner, yaw=found.yaw)
    arm = parts.arm.made(parts.arm.home, manner)
    description = parts.description
    command = command_of(
        description.command, fastest(manner.reach, found.sigma, found.p_x, parts.base, parts.mount, arm.aside)
    )
    space = Workspace(*found.l, *found.psi, *found.z, edges=True)
    gripper = bool(description.hand.gripper)
    return DescribedRobot(
        description.name, description.summary, arm, parts.mount, parts.base, space, command, gripper, mode
    )


@cache
def load(which: str) -> Model:
    """Return the robot called `which`, or in the file `which`; "#MODE" at its end says how its hand is held.

    One of several hands is its first with the others beside it, to be driven in turn, or with "@HAND" that one alone.
    Raises SetupError in one line. Where its workspace is not known it is measured, which takes seconds.
    """
    name, asked = parted(which)
    description, _ = description_of(name)
    if description.hands and not handless(name)[1]:
        tail = f"{IN_MODE}{asked}" if asked else ""
        by_hand = {hand: load(f"{name}{HAND}{hand}{tail}") for hand in description.hands}
        singles = {hand: one for hand, one in by_hand.items() if isinstance(one, DescribedRobot)}
        return HandedRobot(singles, description.driven, description.name)
    parts = parts_for(which)
    mode = parts.description.mode
    for warning in parts.warnings:
        _say(f"{name}: {warning}")
    return robot_of(parts, mode, workspace_of(parts, mode, _say))


def load_one(which: str) -> DescribedRobot:
    """Return the robot in space with one hand that is called `which`, or in the file `which`, as `load` does.

    Raises SetupError, too, for one that moves in the plane, and for one with several hands of which none is chosen.
    """
    model = load(which)
    if hands := hands_of(model):
        raise SetupError(f"{which!r} has several hands, {', '.join(hands)}: choose one with --hand")
    if not isinstance(model, DescribedRobot):
        raise SetupError(f"{which!r} is not a robot in space")
    return model
