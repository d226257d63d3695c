"""Laws and robots by name: entry points, loaded when asked for and not before."""

from __future__ import annotations

import difflib
import inspect
import sys
from collections.abc import Callable
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any, get_type_hints

from overreach.errors import SetupError, UnknownNameError
from overreach.law.blend import Blend
from overreach.law.laws import Law
from overreach.law.workspace import Mount, Workspace
from overreach.model.planar import PlanarRobot
from overreach.types import Frame

LAWS = "overreach.laws"
"""Entry points to makers of a Law. A maker names those of these it needs, each with a default:
workspace: Workspace, blend: Blend, mount: Mount, robot: PlanarRobot."""
ALIKE = 0.85
"""How much a parameter's name must be like one of GIVEN to be taken for a mistyped one."""
GIVEN = ("workspace", "blend", "mount", "robot")
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
    """Return the parameters of the maker of the law called `name`: some of workspace, blend, mount, robot; its own.

    Raises SetupError for one that is nearly one of those, or has no default: it would silently never be given.
    """
    parameters = inspect.signature(_load(LAWS, "law", name)).parameters
    for parameter in parameters.values():
        if parameter.name in GIVEN or parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            continue
        near = difflib.get_close_matches(parameter.name, GIVEN, n=1, cutoff=ALIKE)
        if near or parameter.default is parameter.empty:
            hint = f" Did you mean {near[0]!r}?" if near else ""
            raise SetupError(
                f"the maker of the law {name!r} has a parameter {parameter.name!r}, which nothing gives it.{hint} "
                f"Given are: {', '.join(GIVEN)}; one of its own needs a default."
            )
    return frozenset(parameters)


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
    missing = [part for part in (*get_type_hints(Law), "split") if not hasattr(law, part)]
    if missing:
        raise SetupError(f"the law {name!r} lacks {', '.join(missing)}: see overreach.testing.law.check_law")
    for part, kind in (("frame", Frame), ("workspace", Workspace), ("blend", Blend), ("mount", Mount)):
        if not isinstance(getattr(law, part), kind):
            raise SetupError(f"the law {name!r} has a {part} that is no {kind.__name__}: {getattr(law, part)!r}")
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
