"""Bring what `overreach reproduce --out DIR` found into the README: `python docs/headline.py DIR`."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

HERE = Path(__file__).parent
README = HERE.parent / "README.md"
BEGIN, END = "<!-- headline: written by `make headline` -->\n", "<!-- end of headline -->\n"
FIGURE = "straight.png"


def main() -> None:
    """Put the table between the marks, and the figure beside the page's picture."""
    found = Path(sys.argv[1])
    before, _, rest = README.read_text().partition(BEGIN)
    _, _, after = rest.partition(END)
    README.write_text(before + BEGIN + "\n" + (found / "headline.md").read_text() + "\n" + END + after)
    shutil.copyfile(found / "figures" / FIGURE, HERE / "img" / FIGURE)


if __name__ == "__main__":
    main()
