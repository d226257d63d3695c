"""Functions of arrays, compiled by numba where it is installed, kept on disk for the next time; else as they are.

What is compiled is the function and every function of this package that it calls: the source stays one.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib.util
import os
import sys
from collections.abc import Callable, Sequence
from importlib.metadata import version
from pathlib import Path
from types import FunctionType
from typing import Any

READY = "ready"


def available() -> bool:
    """Say whether there is a compiler."""
    return importlib.util.find_spec("numba") is not None


def cache_folder() -> Path:
    """Return the folder in which this user keeps what can be made again."""
    base = os.environ.get("XDG_CACHE_HOME", "")
    return (Path(base) if os.path.isabs(base) else Path.home() / ".cache") / "overreach"


def _key(functions: Sequence[Callable[..., Any]]) -> tuple[dict[FunctionType, FunctionType], Path]:
    """Return all functions that these call, and the folder that is theirs: of this source, numba and Python."""
    found: dict[FunctionType, FunctionType] = {}
    for function in functions:
        _gather(function, found)
    files = sorted({one.__code__.co_filename for one in found})
    said = [version("numba"), sys.version, *(Path(file).read_text("utf-8") for file in files)]
    key = hashlib.sha256("\n".join(said).encode()).hexdigest()[:16]
    return found, cache_folder() / "numba" / key


def ready(functions: Sequence[Callable[..., Any]]) -> bool:
    """Say whether `functions` have been compiled before, and can be had in a moment."""
    return available() and (_key(functions)[1] / READY).exists()


def is_ready(functions: Sequence[Callable[..., Any]]) -> None:
    """Note that `functions` have been compiled, by calls of all kinds that there will be."""
    with contextlib.suppress(OSError):
        (_key(functions)[1] / READY).touch()


def compile_all(functions: Sequence[Callable[..., Any]]) -> list[Callable[..., Any]]:
    """Return `functions` compiled, with all that they call; the first call of each compiles it, or finds it on disk."""
    import numba
    from numba.core import config

    found, folder = _key(functions)
    config.CACHE_DIR = str(folder)  # type: ignore[attr-defined]  # numba's own way to say it
    made: dict[FunctionType, Any] = {}
    for function in found:
        _compile(function, found, made, numba.njit)
    return [made[function] for function in functions]  # type: ignore[index]  # they are plain functions


def _gather(function: Any, found: dict[FunctionType, FunctionType]) -> None:
    if function in found:
        return
    found[function] = function
    for name in function.__code__.co_names:
        value = function.__globals__.get(name)
        if isinstance(value, FunctionType):
            _gather(value, found)


def _compile(
    function: FunctionType, found: dict[FunctionType, FunctionType], made: dict[FunctionType, Any], njit: Any
) -> Any:
    if function not in made:
        names = dict(function.__globals__)
        for name in function.__code__.co_names:
            value = names.get(name)
            if isinstance(value, FunctionType) and value in found:
                names[name] = _compile(value, found, made, njit)
        copy = FunctionType(function.__code__, names, function.__name__, function.__defaults__)
        copy.__module__, copy.__qualname__ = function.__module__, function.__qualname__
        made[function] = njit(copy, error_model="numpy", fastmath={"contract"}, cache=True)
    return made[function]
