"""Where a robot's model comes from: a file, the menagerie, or this package."""

from __future__ import annotations

import importlib
import importlib.util
import os
from pathlib import Path

import mujoco

from overreach.errors import MissingExtraError, SetupError, UnknownNameError, told
from overreach.extras import pip_line, require
from overreach.model.mujoco.urdf import Source, read_urdf

BUILTIN = "overreach.model.mujoco"
MADE = ("mobile4", "mobile7", "omni5", "omni7")
"""Modules there that make a model."""
PACKAGES = {"stretch_urdf": "stretch"}
"""Modules that bring models, and the extras that bring them."""


def spec_of(model: str, folder: Path) -> Source:
    """Return the model that a description names, to be compiled, and what was repaired.

    folder: where paths begin. Raises SetupError in one line.
    """
    kind, _, name = model.partition(":")
    if kind == "builtin" and name:
        if name not in MADE:
            raise UnknownNameError("built-in model", name, MADE)
        spec: mujoco.MjSpec = importlib.import_module(f"{BUILTIN}.{name}").spec()
        return Source(spec, [], {})
    if kind == "menagerie" and name:
        return spec_from_file(menagerie(name))
    if kind == "package" and name:
        return spec_from_file(packaged(name))
    return spec_from_file(folder / model)


def packaged(name: str) -> Path:
    """Return the file MODULE/PATH that an installed package brings; the module itself is not imported."""
    module, _, path = name.partition("/")
    try:
        found = importlib.util.find_spec(module)
    except ValueError:
        found = None
    if found is None or not found.submodule_search_locations:
        extra = PACKAGES.get(module)
        how = pip_line(extra) if extra else f"install the package that brings {module!r}"
        raise MissingExtraError(f"the model {name!r} is not installed here: {how}")
    return Path(next(iter(found.submodule_search_locations))) / path


def menagerie(name: str) -> Path:
    """Return the file of ROBOT/ENTRY in the menagerie of MuJoCo models, downloaded where it is not here yet."""
    loader = require("mujoco_menagerie", "models", f"the model {name}")
    robot, _, entry = name.partition("/")
    try:
        return Path(loader.get(robot).xml(entry or None))
    except Exception as error:  # of many kinds: unknown names, no network, no such folder
        raise SetupError(
            f"the menagerie's model {name!r} cannot be had: {told(error)}. MENAGERIE_ROOT may name a copy of it."
        ) from None


def spec_from_file(path: Path) -> Source:
    """Return the model in an MJCF or URDF file; raises SetupError in one line."""
    try:
        size = os.path.getsize(path)
        with path.open("rb") as file:
            start = file.read(LOOK)
    except OSError as error:
        raise SetupError(f"cannot read the model file {str(path)!r}: {error.strerror or error}") from None
    if size > LARGEST:
        raise SetupError(f"the model file {str(path)!r} has {size / 1e6:.0f} MB; at most {LARGEST / 1e6:.0f} are read")
    if b"<robot" in start or path.suffix.lower() == ".urdf":
        return read_urdf(path)
    try:
        return Source(mujoco.MjSpec.from_file(str(path)), [], {})
    except (ValueError, RuntimeError) as error:
        raise SetupError(f"the model file {str(path)!r} cannot be used: {one_line(error)}") from None


def compiled(spec: mujoco.MjSpec, what: str) -> mujoco.MjModel:
    """Return the model compiled; raises SetupError in one line."""
    try:
        return spec.compile()
    except (ValueError, RuntimeError) as error:
        raise SetupError(f"{what} cannot be used: {one_line(error)}") from None


def one_line(error: BaseException) -> str:
    """Return what MuJoCo says in several lines as one."""
    return " ".join(str(error).split())


LOOK = 4096
LARGEST = 100_000_000
"""Greatest size [bytes] of a model file that is read."""
