"""Files that are written whole or not at all."""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path
from typing import Any

from overreach.errors import SetupError


def check_writable(path: Path, option: str) -> None:
    """Raise SetupError, before any work is done, if `path`, given with `option`, cannot be written."""
    folder = path.parent
    if path.is_dir():
        raise SetupError(
            f"{option} {str(path)!r} is a folder: name a file, such as {str(path / ('run' + _suffix(option)))!r}"
        )
    if folder.exists() and not folder.is_dir():
        raise SetupError(f"{option} {str(path)!r}: {str(folder)!r} is a file: name a file in a folder")
    if not folder.is_dir():
        raise SetupError(f"{option} {str(path)!r}: there is no folder {str(folder)!r}: make it first")
    try_to_write(folder, f"{option} {str(path)!r}")


def try_to_write(folder: Path, asked: str) -> None:
    """Raise SetupError, with a text that begins with `asked`, if no file can be made in `folder`.

    This tries to make one: os.access says yes to folders in which nothing can be made.
    """
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise SetupError(f"{asked}: cannot write in {str(folder)!r} ({error.strerror}): name another folder") from None


def _suffix(option: str) -> str:
    return ".json" if option == "--json" else ".csv"


def write_text(path: Path, text: str) -> None:
    """Write `text` as UTF-8 with bare newlines, under another name first."""
    handle, part = tempfile.mkstemp(prefix=path.name, suffix=".part", dir=path.parent)
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="") as stream:
            stream.write(text)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(part, 0o666 & ~umask)
        os.replace(part, path)
    except BaseException:
        os.unlink(part)
        raise


def write_json(path: Path, value: Any) -> None:
    """Write `value` as JSON, indented."""
    write_text(path, json.dumps(value, indent=2) + "\n")
