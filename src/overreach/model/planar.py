"""The planar robot: a base that cannot move sideways and an arm of two links (2R)."""

from __future__ import annotations

import importlib.resources
import tomllib
from functools import cache
from typing import Any

import msgspec

from overreach.arm.mount import Mount
from overreach.arm.planar import Arm2R
from overreach.errors import SetupError
from overreach.gate.limits import Limits
from overreach.model.base import Base, Start
from overreach.model.model import check_reach, check_workspace
from overreach.model.workspace import Workspace
from overreach.types import Record


class PlanarRobot(Record, frozen=True):
    """A `overreach.model.model.Model` in the plane; `data/planar.toml` is one."""

    name: str
    arm: Arm2R
    base: Base
    workspace: Workspace
    start: Start
    mount: Mount = Mount()
    gripper: bool = False
    summary: str = ""
    command: Limits = Limits()
    bands: tuple[float, float, float] = (0.1, 0.1, 0.1)

    def placed(self, mount: Mount, workspace: Workspace) -> PlanarRobot:
        """Return the same with its arm at another place, and another workspace; raises WorkspaceError."""
        return msgspec.structs.replace(self, mount=mount, workspace=workspace)

    def __post_init__(self) -> None:
        check_workspace(self, self.workspace)
        check_reach(self, self.start.l)


def load_planar(text: str = "") -> PlanarRobot:
    """Return the robot described by TOML `text`; what it leaves out is as in `data/planar.toml`.

    Raises SetupError that says what is wrong, and where.
    """
    usual = importlib.resources.files("overreach.model").joinpath("data/planar.toml").read_text("utf-8")
    try:
        tables, given = tomllib.loads(usual), tomllib.loads(text)
        for key, value in given.items():
            own = tables.get(key)
            tables[key] = own | value if isinstance(own, dict) and isinstance(value, dict) else value
        return msgspec.convert(tables, PlanarRobot)
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise SetupError(f"robot description: {error}") from None


_built_in = cache(load_planar)


def planar(**changes: Any) -> PlanarRobot:
    """The paper's robot: a differential-drive base with a planar arm of two links. `changes`: other fields."""
    return msgspec.structs.replace(_built_in(), **changes) if changes else _built_in()
