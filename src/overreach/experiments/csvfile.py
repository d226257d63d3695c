"""The run as a CSV file: written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

from overreach.errors import SetupError
from overreach.experiments.run import Row


def check_writable(path: Path) -> None:
    """Raise SetupError where `path` cannot become a file, before any work is done."""
    folder = path.parent
    if path.is_dir():
        raise SetupError(f"--out {str(path)!r} is a folder: name a file, such as {str(path / 'run.csv')!r}")
    if not folder.is_dir():
        raise SetupError(f"--out {str(path)!r}: there is no folder {str(folder)!r}: make it first")
    if not os.access(folder, os.W_OK):
        raise SetupError(f"--out {str(path)!r}: the folder {str(folder)!r} is not writable")


def write_csv(path: Path, rows: Sequence[Row]) -> None:
    """Write `rows` under a header of the field names; numbers round-trip exactly."""
    check_writable(path)
    handle, part = tempfile.mkstemp(prefix=path.name, suffix=".part", dir=path.parent)
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="") as stream:
            stream.write(",".join(Row._fields) + "\n")
            stream.writelines(",".join(map(repr, row)) + "\n" for row in rows)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(part, 0o666 & ~umask)
        os.replace(part, path)
    except BaseException:
        os.unlink(part)
        raise
