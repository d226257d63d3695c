"""What is measured once and kept for this user: one small file by its key, written as a whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path

import msgspec

from overreach.compiled import cache_folder
from overreach.model.description import Measured


def kept(key: str, mode: str) -> Measured | None:
    """Return the workspace that is kept for a model's key and a mode; None if there is none that can be read."""
    try:
        return msgspec.json.decode((cache_folder() / "workspaces" / f"{key}-{mode}.json").read_bytes(), type=Measured)
    except (OSError, msgspec.MsgspecError):
        return None


def keep(measured: Measured, mode: str) -> None:
    """Keep a workspace; where nothing can be written, it is measured again next time."""
    _write(cache_folder() / "workspaces" / f"{measured.model}-{mode}.json", msgspec.json.encode(measured))


def kept_home(key: str, mode: str) -> tuple[float, ...] | None:
    """Return the home posture that is kept for a model's key and a mode; None if there is none that can be read."""
    try:
        raw = (cache_folder() / "homes" / f"{key}-{mode}.json").read_bytes()
        return msgspec.json.decode(raw, type=tuple[float, ...])
    except (OSError, msgspec.MsgspecError):
        return None


def keep_home(home: tuple[float, ...], key: str, mode: str) -> None:
    """Keep a home posture."""
    _write(cache_folder() / "homes" / f"{key}-{mode}.json", msgspec.json.encode(home))


def _write(path: Path, raw: bytes) -> None:
    folder = path.parent
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        handle, part = tempfile.mkstemp(dir=folder, suffix=".part")
        with os.fdopen(handle, "wb") as file:
            file.write(raw)
        os.replace(part, path)
