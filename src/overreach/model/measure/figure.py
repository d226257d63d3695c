"""A measured workspace as a figure: how much of each cell is reached, from above and from the side, and the sector."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from overreach.arm.mount import Mount
from overreach.arm.spatial.screws import Array
from overreach.extras import require
from overreach.model.measure.measure import Result

LONGEST = 8.6
"""Width of both panels together [inch]; a metre is as long in both."""
FINE = 24
"""Points along an arc of the sector."""
REACHED = "#8fb9c2"


def edges(middles: Array) -> Array:
    """Return the edges (N + 1,) of cells about evenly spaced `middles` (N,)."""
    half = 0.5 * (middles[1] - middles[0])
    return np.append(middles - half, middles[-1] + half)


def draw(result: Result, mount: Mount, footprint: tuple[float, float], title: str, path: Path) -> None:
    """Write the figure to `path`, as its suffix says; raises MissingExtraError without matplotlib."""
    require("matplotlib", "figures", "the figure")
    from matplotlib.colors import LinearSegmentedColormap
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch, Polygon, Rectangle
    from matplotlib.pyplot import close

    from overreach.look import ARM, BASE, INK, LINE, MUTED, PANEL, panels

    walked = result.walked
    l, psi, z = edges(walked.l), edges(walked.psi), edges(walked.z)
    turn = psi + mount.yaw
    x, y = mount.s_x + np.outer(l, np.cos(turn)), mount.s_y + np.outer(l, np.sin(turn))
    length, width = footprint
    reached = np.any(walked.ok, axis=2)
    some = np.zeros(x.shape, bool)
    for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)):
        some[i : i + reached.shape[0], j : j + reached.shape[1]] |= reached
    lengths, heights = l[1:][np.any(reached, axis=1)], z[1:][np.any(walked.ok, axis=(0, 1))]
    spans = [
        _span([*x[some], -0.5 * length, 0.5 * length]), _span([*y[some], -0.5 * width, 0.5 * width]),
        _span([0.0, *lengths]), _span([0.0, *heights]),
    ]  # fmt: skip
    wide = [span[1] - span[0] for span in spans]
    scale = LONGEST / (wide[0] + wide[2])
    figure, ((above, side),) = panels(
        1, 2, LONGEST + 1.4, scale * max(wide[1], wide[3]) + 1.2, gridspec_kw={"width_ratios": (wide[0], wide[2])}
    )
    shade = LinearSegmentedColormap.from_list("reached", [PANEL, REACHED])
    shade.set_bad((0.0, 0.0, 0.0, 0.0))
    for axes, grid, ok in (
        (above, (x, y), walked.ok.mean(axis=2)),
        (side, (*np.meshgrid(l, z, indexing="ij"),), walked.ok.mean(axis=1)),
    ):
        most = max(float(ok.max()), 1e-9)
        axes.pcolormesh(*grid, np.ma.masked_equal(ok / most, 0.0), cmap=shade, vmin=-0.3, vmax=1.0, zorder=1.5)
        axes.set_aspect("equal", anchor="N")

    (l_a, l_b), (psi_a, psi_b), (z_a, z_b) = result.measured.l, result.measured.psi, result.measured.z
    arc = np.linspace(psi_a, psi_b, FINE) + mount.yaw
    r, a = np.concatenate((np.full(FINE, l_b), np.full(FINE, l_a))), np.concatenate((arc, arc[::-1]))
    outline: dict[str, Any] = {"closed": True, "fill": False, "edgecolor": ARM, "linewidth": 1.8, "zorder": 3}
    above.add_patch(Polygon(np.stack((mount.s_x + r * np.cos(a), mount.s_y + r * np.sin(a)), axis=1), **outline))
    side.add_patch(Polygon(((l_a, z_a), (l_b, z_a), (l_b, z_b), (l_a, z_b)), **outline))
    i, j, k = walked.home
    hand_x = mount.s_x + walked.l[i] * np.cos(walked.psi[j] + mount.yaw)
    hand_y = mount.s_y + walked.l[i] * np.sin(walked.psi[j] + mount.yaw)
    above.plot(hand_x, hand_y, "x", color=INK, markersize=6, zorder=4)
    side.plot(walked.l[i], walked.z[k], "x", color=INK, markersize=6, zorder=4)

    above.add_patch(Rectangle((-0.5 * length, -0.5 * width), length, width, facecolor=LINE, edgecolor=BASE, zorder=1.2))
    above.plot(mount.s_x, mount.s_y, "o", color=BASE, markersize=4.5, zorder=4)
    side.axhline(0.0, color=MUTED, linewidth=1.2)
    side.axvline(0.0, color=BASE, linewidth=1.2)
    above.set(xlabel="x [m]", ylabel="y [m]", title="From above", xlim=spans[0], ylim=spans[1])
    side.set(xlabel="l, from the shoulder [m]", ylabel="z [m]", title="From the side", xlim=spans[2], ylim=spans[3])
    figure.suptitle(title + "\n", x=0.01, ha="left")
    figure.legend(
        handles=[
            Patch(facecolor="none", edgecolor=ARM, linewidth=1.8, label="workspace"),
            Patch(facecolor=REACHED, label="reached at most heights, or bearings; paler: at few"),
            Line2D([], [], color=INK, marker="x", linestyle="none", label="home"),
            Patch(facecolor=LINE, edgecolor=BASE, label="base"),
            Line2D([], [], color=BASE, marker="o", markersize=4.5, linestyle="none", label="shoulder"),
        ],
        loc="outside lower left", ncols=5,
    )  # fmt: skip
    figure.savefig(path, dpi=150)
    close(figure)


def _span(values: list[float]) -> tuple[float, float]:
    """Return the least and the greatest of `values` with a little room."""
    low, high = float(min(values)), float(max(values))
    room = 0.04 * (high - low)
    return low - room, high + room
