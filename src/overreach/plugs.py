"""Laws and robots by name: entry points, loaded when asked for and not before."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from overreach.errors import UnknownNameError
from overreach.law.blend import Blend
from overreach.law.laws import Law
from overreach.law.workspace import Mount, Workspace
from overreach.model.planar import PlanarRobot

LAWS = "overreach.laws"
"""Entry points to makers: (workspace, blend, mount) -> Law."""
ROBOTS = "overreach.robots"
"""Entry points to makers: () -> PlanarRobot."""


@cache
def _points(group: str) -> dict[str, EntryPoint]:
    """Read the installed packages' entry points, once: it takes milliseconds."""
    return {point.name: point for point in entry_points(group=group)}


def names(group: str) -> list[str]:
    """Return the names in an entry-point group, sorted."""
    return sorted(_points(group))


def _load(group: str, kind: str, name: str) -> Callable[..., Any]:
    found = _points(group)
    if name not in found:
        raise UnknownNameError(kind, name, found)
    maker: Callable[..., Any] = found[name].load()
    return maker


def load_law(
    name: str, workspace: Workspace | None = None, blend: Blend | None = None, mount: Mount | None = None
) -> Law:
    """Return the law called `name`; raises UnknownNameError with the valid names."""
    law: Law = _load(LAWS, "law", name)(workspace, blend, mount)
    return law


def load_robot(name: str) -> PlanarRobot:
    """Return the description of the robot called `name`; raises UnknownNameError with the valid names."""
    robot: PlanarRobot = _load(ROBOTS, "robot", name)()
    return robot


def summaries(group: str) -> dict[str, str]:
    """Return name -> the first line of what its maker says of itself."""
    lines = {}
    for name in names(group):
        doc = _load(group, "plug", name).__doc__ or ""
        lines[name] = doc.strip().splitlines()[0] if doc.strip() else ""
    return lines
