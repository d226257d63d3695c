"""Text files as people have them: with a byte order mark or without."""

from __future__ import annotations

import codecs
from pathlib import Path

MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),  # before UTF-16, with whose mark it begins
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
"""The marks that some editors, spreadsheets and shells write first, and what follows them."""


def read_text(path: Path) -> str:
    """Return a file's text: in the encoding that its byte order mark says, else UTF-8.

    Line ends are left as they are. Raises OSError or UnicodeDecodeError.
    """
    raw = path.read_bytes()
    encoding = next((name for mark, name in MARKS if raw.startswith(mark)), "utf-8")
    return raw.decode(encoding)
