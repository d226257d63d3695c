"""Draw how a base swings round behind a telescope, on drives of stretch: `make pictures`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.patches import Polygon

from overreach.check.driven import drive
from overreach.check.judge import in_world
from overreach.check.streams import DT_S
from overreach.look import ARM, BASE, HAND, INK, LINE, MUTED, panels
from overreach.model.described import DescribedRobot
from overreach.plugs import load_model

OUT = Path(__file__).parent / "img" / "stretch.png"
V = 0.15
DRIVES = (
    ("out to its side: the base swings round behind it", ((16.0, 0.0, -V),)),
    ("inward, past the base", ((16.0, 0.0, V),)),
    ("ahead, then around a corner", ((9.0, V, 0.0), (12.0, 0.0, -V))),
)
"""Title; seconds, v_x and v_y [m/s] along the hand's heading."""
EVERY_S = 2.0


def commands(parts: tuple[tuple[float, float, float], ...]) -> np.ndarray:
    """Return v, w, v_z, v_y for each period."""
    return np.concatenate([np.tile((v_x, 0.0, 0.0, v_y), (round(s / DT_S), 1)) for s, v_x, v_y in parts])


def from_above(axes: Any, model: DescribedRobot, given: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Draw a drive from above; return the arm's length [m] and the scale."""
    driven = drive(model, given)
    R, p, _ = model.arm.posture_at_home.forward(driven.q)
    x, y = in_world(model, driven.base, p)
    length, width = model.base.footprint
    corners = 0.5 * np.array(((-length, -width), (length, -width), (length, width), (-length, width)))
    for k in range(0, len(x), round(EVERY_S / DT_S)):
        b_x, b_y, turn = driven.base[k]
        c, s = np.cos(turn), np.sin(turn)
        axes.add_patch(
            Polygon(corners @ np.array(((c, s), (-s, c))) + (b_x, b_y), fc="none", ec=BASE, lw=0.8, alpha=0.6)
        )
        axes.plot((b_x, b_x + 0.5 * length * c), (b_y, b_y + 0.5 * length * s), color=BASE, lw=1.4, alpha=0.8)
        m_x, m_y = b_x + c * model.mount.s_x, b_y + s * model.mount.s_x
        axes.plot((m_x, x[k]), (m_y, y[k]), color=ARM, lw=1.6, alpha=0.8)
        bearing = turn + model.mount.yaw
        a_x, a_y, _ = R[k] @ np.array(model.arm.manner.approach)
        g_x, g_y = np.cos(bearing) * a_x - np.sin(bearing) * a_y, np.sin(bearing) * a_x + np.cos(bearing) * a_y
        axes.plot((x[k], x[k] + 0.14 * g_x), (y[k], y[k] + 0.14 * g_y), color=HAND, lw=2.2)
    axes.plot(driven.base[:, 0], driven.base[:, 1], color=BASE, lw=0.9, ls=(0, (4, 2)))
    axes.plot(x, y, color=HAND, lw=1.3)
    axes.plot(x[0], y[0], "o", color=INK, ms=4)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x [m]")
    return np.hypot(p[:, 0], p[:, 1])[:-1], driven.scale


def main() -> None:
    """Draw."""
    model = load_model("stretch")
    assert isinstance(model, DescribedRobot)
    figure, axes = panels(2, len(DRIVES), 12.0, 3.2, gridspec_kw={"height_ratios": (2.3, 1.0)})
    space = model.workspace
    for k, (title, parts) in enumerate(DRIVES):
        above, below = axes[0, k], axes[1, k]
        given = commands(parts)
        l, scale = from_above(above, model, given)
        above.set_title(title)
        t = np.arange(len(l)) * DT_S
        below.axhspan(space.l_min, space.l_max, color=LINE, alpha=0.35, lw=0)
        below.plot(t, l, color=ARM, label="l [m]")
        below.plot(t, scale, color=MUTED, lw=1.0, label="scale")
        below.set_ylim(0.0, 1.05)
        below.set_xlim(0.0, t[-1])
        below.set_xlabel("t [s]")
    axes[0, 0].set_ylabel("y [m]")
    axes[1, 0].set_ylabel("l [m], scale")
    axes[1, 0].legend(loc="lower right")
    figure.savefig(OUT, dpi=110)


if __name__ == "__main__":
    main()
