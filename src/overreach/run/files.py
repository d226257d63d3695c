"""Files that are written whole or not at all."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from overreach.errors import SetupError
from overreach.run.row import Row


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


def write_csv(path: Path, rows: Sequence[Row]) -> None:
    """Write `rows` under a header of the field names, a column per joint; numbers round-trip exactly."""
    joints = [f"theta_{k + 1}" for k in range(len(rows[0].theta))]
    write_table(path, [*Row._fields[:-1], *joints], [(*row[:-1], *row.theta) for row in rows])


def write_table(path: Path, header: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    """Write any table of numbers and names under `header`; numbers round-trip exactly."""
    lines = [",".join(value if isinstance(value, str) else repr(value) for value in row) + "\n" for row in rows]
    write_text(path, ",".join(header) + "\n" + "".join(lines))


def write_json(path: Path, value: Any) -> None:
    """Write `value` as JSON, indented."""
    write_text(path, json.dumps(value, indent=2) + "\n")
