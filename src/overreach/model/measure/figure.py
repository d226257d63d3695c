"""A measured workspace as a figure: its cells from above and from the side, with the sector and the robot's outline."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from overreach.arm.mount import Mount
from overreach.extras import require
from overreach.model.measure.measure import Result

REACHED, SECTOR, BASE = "#b9c7d6", "#2c6fbb", "#8a8a8a"


def draw(result: Result, mount: Mount, footprint: tuple[float, float], title: str, path: Path) -> None:
    """Write the figure to `path`, as its suffix says; raises MissingExtraError without matplotlib."""
    require("matplotlib", "figures", "the figure")
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle

    walked, box = result.walked, result.box
    figure = Figure(figsize=(9.0, 4.4), layout="constrained")
    FigureCanvasAgg(figure)
    above, side = figure.subplots(1, 2)
    turn = walked.psi + mount.yaw
    x = mount.s_x + walked.l[:, None] * np.cos(turn)[None, :]
    y = mount.s_y + walked.l[:, None] * np.sin(turn)[None, :]
    sector = np.zeros(walked.ok.shape[:2], bool)
    sector[box.l[0] : box.l[1] + 1, box.psi[0] : box.psi[1] + 1] = True
    for cells, colour, name in ((walked.ok.any(axis=2), REACHED, "reached"), (sector, SECTOR, "workspace")):
        above.scatter(x[cells], y[cells], s=7, color=colour, label=name, linewidths=0)
    length, width = footprint
    above.add_patch(Rectangle((-0.5 * length, -0.5 * width), length, width, fill=False, edgecolor=BASE))
    above.plot(mount.s_x, mount.s_y, "o", color=BASE, markersize=4)
    above.annotate(
        "shoulder", (mount.s_x, mount.s_y), textcoords="offset points", xytext=(-4, -12), color="#555555", fontsize=8
    )
    above.set(xlabel="x [m]", ylabel="y [m]", title="from above", aspect="equal")
    l, z = np.meshgrid(walked.l, walked.z, indexing="ij")
    inside = np.zeros((len(walked.l), len(walked.z)), bool)
    inside[box.l[0] : box.l[1] + 1, box.z[0] : box.z[1] + 1] = True
    side.scatter(l[walked.ok.any(axis=1)], z[walked.ok.any(axis=1)], s=7, color=REACHED, linewidths=0)
    side.scatter(l[inside], z[inside], s=7, color=SECTOR, linewidths=0)
    side.axhline(0.0, color=BASE, linewidth=1)
    side.set(xlabel="l [m]", ylabel="z [m]", title="from the side", aspect="equal")
    above.legend(loc="upper left", frameon=False, fontsize=8)
    figure.suptitle(title)
    figure.savefig(path, dpi=150)
