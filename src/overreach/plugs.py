"""Laws and robots by name: entry points, loaded when asked for and not before."""

from __future__ import annotations

import inspect
import sys
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
"""Entry points to makers of a Law. A maker names those of these it needs, each with a default:
workspace: Workspace, blend: Blend, mount: Mount, robot: PlanarRobot."""
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


def takes(name: str) -> frozenset[str]:
    """Return what the law called `name` is made from: some of workspace, blend, mount, robot."""
    return frozenset(inspect.signature(_load(LAWS, "law", name)).parameters)


def loaded(name: str) -> bool:
    """Say whether the law called `name` is in memory: to load another may take a second (it may import numpy)."""
    point = _points(LAWS).get(name)
    return point is not None and point.module in sys.modules


def load_law(
    name: str,
    workspace: Workspace | None = None,
    blend: Blend | None = None,
    mount: Mount | None = None,
    robot: PlanarRobot | None = None,
) -> Law:
    """Return the law called `name`, made from those of the other arguments that its maker names.

    Raises UnknownNameError with the valid names, or MissingExtraError where it needs a library that is not installed.
    """
    given = {"workspace": workspace, "blend": blend, "mount": mount, "robot": robot}
    law: Law = _load(LAWS, "law", name)(**{key: given[key] for key in takes(name) if given.get(key) is not None})
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
