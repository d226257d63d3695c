"""How the figures look: the page's colours, by role, so that the same drawing serves light and dark."""

from __future__ import annotations

import io
import re
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

INK, MUTED, LINE, PANEL = "#14191f", "#55606d", "#d5dbe2", "#ffffff"
ARM, BASE, HAND, STOP, OK = "#0b7285", "#c2530a", "#6741d9", "#c4232b", "#1f7a37"
ROLES = {
    INK: "ink", MUTED: "muted", LINE: "line", PANEL: "panel",
    ARM: "arm", BASE: "base", HAND: "hand", STOP: "stop", OK: "ok",
}  # fmt: skip
"""Colours as drawn (on white) -> the role under which the page has one for light and one for dark."""

mpl.rcParams.update(
    {
        "figure.facecolor": PANEL, "axes.facecolor": PANEL, "savefig.facecolor": PANEL, "figure.dpi": 100,
        "font.size": 9, "axes.titlesize": 9.5, "axes.labelsize": 9, "legend.fontsize": 8, "figure.titlesize": 11,
        "text.color": INK, "axes.labelcolor": INK, "axes.titlecolor": INK, "legend.labelcolor": INK,
        "xtick.color": MUTED, "ytick.color": MUTED, "xtick.labelsize": 8, "ytick.labelsize": 8,
        "axes.edgecolor": MUTED, "axes.linewidth": 0.7, "axes.spines.top": False, "axes.spines.right": False,
        "axes.grid": True, "grid.color": LINE, "grid.linewidth": 0.6, "axes.axisbelow": True,
        "lines.linewidth": 1.5, "lines.solid_capstyle": "round", "legend.frameon": False, "axes.titlelocation": "left",
        "figure.constrained_layout.use": True, "svg.fonttype": "path", "path.simplify_threshold": 0.4,
    }
)  # fmt: skip


def panels(rows: int, columns: int, width: float = 9.2, height: float = 1.75, **more: Any) -> tuple[Figure, Any]:
    """Return a figure with rows x columns axes, `height` [inch] a row."""
    return plt.subplots(rows, columns, figsize=(width, height * rows), squeeze=False, **more)


def limit(axes: Axes, values: Sequence[float], label: str, horizontal: bool = True) -> None:
    """Draw limits in: dashed lines at `values`, with one entry in the legend."""
    draw = axes.axhline if horizontal else axes.axvline
    for k, value in enumerate(values):
        draw(value, color=STOP, linewidth=0.9, linestyle=(0, (4, 3)), label=label if k == 0 else None, zorder=1.5)


def legend(axes: Axes, where: Any = "best", columns: int = 1) -> None:
    """Draw the legend, without a frame but with a ground that keeps lines out of the words."""
    axes.legend(
        loc=where, ncols=columns, handlelength=1.5, columnspacing=1.2, frameon=True, framealpha=0.75, edgecolor="none"
    )


def thin(values: Sequence[Any], most: int = 900) -> list[Any]:
    """Return every n-th value and the last, about `most` of them: more than a figure can show is not drawn."""
    stride = max(1, len(values) // most)
    some = list(values[::stride])
    if (len(values) - 1) % stride:
        some.append(values[-1])
    return some


def check(name: str, figure: Figure) -> None:
    """Raise ValueError for a figure that nobody should see: an empty panel, no labels, a label without its unit."""
    panels = figure.get_axes()
    if not all(axes.lines or axes.patches or axes.collections for axes in panels):
        raise ValueError(f"figure {name}: a panel is empty")
    labels = [label for axes in panels for label in (axes.get_xlabel(), axes.get_ylabel()) if label]
    if not labels or not all("[" in label for label in labels):
        raise ValueError(f"figure {name}: a label without its unit: {labels}")
    for which in ("xlabel", "ylabel"):
        named = any(getattr(axes, f"get_{which}")() for axes in panels)
        words = which == "ylabel" and any(re.search("[a-z]", tick.get_text()) for tick in panels[0].get_yticklabels())
        if not (named or words):
            raise ValueError(f"figure {name}: no {which}")


def as_svg(figure: Figure, name: str) -> str:
    """Return `figure` as SVG text; the same figure gives the same text."""
    stream = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": name}):
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": "overreach"})
    return stream.getvalue()


def inline(svg: str, name: str, alt: str) -> str:
    """Return SVG text for the inside of a page: colours by role, ids of its own, no size but its proportions."""
    body = svg[svg.index("<svg") :]
    body = re.sub(r"<metadata>.*?</metadata>", "", body, flags=re.DOTALL)
    body = re.sub(r'(<svg[^>]*?) width="[^"]*"', r"\1", body, count=1)
    body = re.sub(r'(<svg[^>]*?) height="[^"]*"', r"\1", body, count=1)
    body = body.replace("<svg", f'<svg role="img" aria-label="{alt}"', 1)
    body = re.sub(r'id="([^"]+)"', rf'id="{name}-\1"', body)
    body = re.sub(r'(href="#|url\(#)', rf"\1{name}-", body)
    for colour, role in ROLES.items():
        body = body.replace(colour, f"var(--{role})")
    return body
