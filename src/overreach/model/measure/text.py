"""A measured workspace in words: the table for a description, and a drawing of its cells from two sides."""

from __future__ import annotations

import re
import tomllib
from typing import Any

import numpy as np

from overreach.arm.spatial.screws import Array
from overreach.errors import SetupError
from overreach.model.description import Measured
from overreach.model.measure.measure import Result

INSIDE, REACHED, MISSED = "#", "+", "."
"""A column of cells: wholly in the sector, reached somewhere, never."""


def table(measured: Measured, mode: str, where: str = "workspace") -> str:
    """Return the table [workspace.MODE], or of one of several hands [hands.NAME.workspace.MODE]: `where` it is."""
    lines = [f"[{where}.{mode}]"]
    for name in ("l", "psi", "z"):
        low, high = getattr(measured, name)
        unit = "rad" if name == "psi" else "m"
        lines.append(f"{name} = [{low:g}, {high:g}]".ljust(37) + f"# [{unit}]")
    lines.append(f"held = [{', '.join(f'{word!r}' for word in measured.held)}]".replace("'", '"'))
    if measured.yaw:
        lines.append(f"yaw = {measured.yaw:g}".ljust(37) + "# [rad]")
    lines.append(f"sigma = {measured.sigma:g}".ljust(37) + "# [m/s]")
    lines.append(f"p_x = {measured.p_x:g}".ljust(37) + "# [m]")
    lines.append(f'model = "{measured.model}"')
    return "\n".join(lines) + "\n"


def with_table(text: str, measured: Measured, mode: str, where: str = "workspace") -> str:
    """Return the TOML `text` of a description with this table in it, in place of the one it had. where: as in `table`.

    Raises SetupError for a text in which the table cannot be put.
    """
    kept: list[str] = []
    own: list[str] | None = None
    place = None
    header = r"\s*\.\s*".join(rf"[\"']?{part}[\"']?" for part in (*where.split("."), mode))
    for line in text.splitlines():
        if line.lstrip().startswith("["):
            kept += _behind(own or [])
            own = [] if re.match(rf"\s*\[\s*{header}\s*\]", line) else None
            place = len(kept) if own is not None else place
        (kept if own is None else own).append(line)
    kept += _behind(own or [])
    made = table(measured, mode, where).splitlines()
    if place is None:
        place = len("\n".join(kept).rstrip().splitlines())
        kept = [*kept[:place], *([""] if place else [])]
        place = len(kept)
    elif place < len(kept) and kept[place].lstrip().startswith("["):
        made.append("")
    whole = "\n".join([*kept[:place], *made, *kept[place:]]).rstrip() + "\n"
    try:
        tomllib.loads(whole)
    except tomllib.TOMLDecodeError as error:
        raise SetupError(f"[{where}.{mode}] cannot be put into this description: {error}") from None
    return whole


def _behind(lines: list[str]) -> list[str]:
    """Return the comments and empty lines at the end of a table: they belong to what follows it."""
    end = len(lines)
    while end > 0 and (not lines[end - 1].strip() or lines[end - 1].lstrip().startswith("#")):
        end -= 1
    return lines[end:]


def drawing(result: Result) -> str:
    """Return two pictures of the cells, in letters: psi over l, and z over l."""
    walked, box = result.walked, result.box
    inside = np.zeros(walked.ok.shape, bool)
    inside[tuple(slice(a, b + 1) for a, b in box[:3])] = True
    top = _picture(np.any(walked.ok, axis=2), np.any(inside, axis=2), walked.psi, "psi [rad]")
    side = _picture(np.any(walked.ok, axis=1), np.any(inside, axis=1), walked.z, "z [m]")
    scale = f"l = {walked.l[0]:.2f} to {walked.l[-1]:.2f} m, from left to right"
    above = f"from above ({INSIDE} in the sector, {REACHED} reached at some height)"
    return f"{above}\n{top}\n\nfrom the side\n{side}\n{scale}"


def _picture(reached: Any, inside: Any, rows: Array, label: str) -> str:
    lines = [label]
    for k in range(len(rows) - 1, -1, -1):
        if reached[:, k].any() or k % 4 == 0:
            cells = "".join(
                INSIDE if inside[i, k] else REACHED if reached[i, k] else MISSED for i in range(reached.shape[0])
            )
            lines.append(f"{rows[k]:7.2f} {cells}")
    return "\n".join(lines)
