"""A robot from its model file alone: described by guesses, its home posture found and kept."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import msgspec

from overreach.errors import SetupError, WorkspaceError
from overreach.model.cache import keep_home, kept_home
from overreach.model.description import Description, read_description
from overreach.model.measure.homes import find_homes, with_home
from overreach.model.measure.measure import expected_speed, manner_for
from overreach.model.mujoco.describe import describe
from overreach.model.mujoco.robot import Parts, parts_of


def guessed(path: Path, say: Callable[[str], None]) -> Description:
    """Return the guessed description of the robot in a model file; raises SetupError where guessing would not do."""
    text, warnings, unknown = describe(path)
    if unknown:
        raise SetupError(
            f"the model file {str(path)!r} has no speeds for {', '.join(unknown)}: "
            f"`overreach describe {path} --out robot.toml`, look them up, fill them in, and use robot.toml"
        )
    for warning in warnings:
        say(f"{path.name}: {warning}")
    return read_description(text, f"description of {str(path)!r}")


def homed(description: Description, folder: Path, mode: str, say: Callable[[str], None]) -> Description:
    """Return a guessed description with the best home that is found for a mode; kept for next time."""
    parts = parts_of(description, folder)
    home = kept_home(parts.key, mode)
    if home is None:
        say(f"looking for a home posture of {description.name} ({mode}), which takes a minute; kept for next time")
        v = expected_speed(parts.arm.manner.reach, parts.base)
        held = parts._replace(arm=parts.arm.held(manner_for(parts.arm, mode, v)))

        def at(q: tuple[float, ...]) -> Parts:
            return with_home(held, q)

        homes = find_homes(held, at)
        if not homes:
            raise WorkspaceError(
                f"no home posture of {description.name} was found about which there is a workspace: "
                "`overreach describe`, look at the guesses, and use the description"
            )
        home = homes[0].q
        keep_home(home, parts.key, mode)
    return msgspec.structs.replace(description, home=home)
