"""Section 6b: by how much the paper's law leaves its command, over bearing and speed."""

from __future__ import annotations

from math import hypot, tan

import numpy as np

from overreach.law.authority import ee_velocity
from overreach.law.blend import Tanh
from overreach.law.laws import Exact, Paper, Share
from overreach.look import ARM, BASE, INK, legend, limit, panels
from overreach.model.planar import planar
from overreach.reproduce.lab import Lab, Section

BEYOND = 0.95
"""Where it is drawn: well beyond L_max = 0.85 m, where the base has everything (mu = 1 to 5e-5)."""
LEVELS = (0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3)


def error(share: Share, psi: float, v_c: float) -> float:
    """Return |true velocity - command| [m/s] of the hand, pushed outward at v_c [m/s], in rigid-body kinematics."""
    split = share(BEYOND, psi, v_c, 0.0)
    got = ee_velocity(BEYOND, psi, split.v_b, split.w_b, split.v_m, split.w_m, (0.0, 0.0, 0.0))
    return hypot(got[0] - v_c * split.scale, got[1])


def section(lab: Lab) -> Section:
    """Map the error of `paper`; beside it a cut at 0.4 m/s with the formula and with `exact`."""
    his, ours = Paper().bind(planar()), Exact(blend=Tanh()).bind(planar())
    psi, v_c = np.linspace(-0.7, 0.7, 71), np.linspace(0.0, 0.4, 41)
    field = np.array([[error(his, float(p), float(v)) for p in psi] for v in v_c])
    zero = max(error(ours, float(p), float(v)) for p in psi for v in v_c)
    formula = max(
        abs(error(his, float(p), 0.4) - his(BEYOND, float(p), 0.4, 0.0).mu * abs(0.4 * tan(float(p)))) for p in psi
    )
    rows = [(float(v), float(p), float(field[k][j])) for k, v in enumerate(v_c) for j, p in enumerate(psi)]
    lab.data("distortion", ("v_c", "psi", "error"), rows)
    lab.physics["distortion"] = {
        "paper_worst": float(field.max()),
        "paper_at_0.4_and_0.6": error(his, 0.6, 0.4),
        "paper_differs_from_formula_by": formula,
        "exact_worst": zero,
    }

    figure, ((left, right),) = panels(1, 2, height=3.1)
    shades = [f"{BASE}{round(255 * 0.85 * k / (len(LEVELS) - 1)):02x}" for k in range(len(LEVELS))]
    left.contourf(psi, v_c, field, levels=(*LEVELS, 0.4), colors=shades)
    lines = left.contour(psi, v_c, field, levels=LEVELS[1:], colors=INK, linewidths=0.6)
    left.clabel(lines, fmt="%.2f", fontsize=7.5)
    limit(left, (-0.6, 0.6), "limits of the workspace", horizontal=False)
    left.set(xlabel="ψ [rad]", ylabel="$v_c$ [m/s]", title="paper: error of the hand's velocity [m/s]")
    left.grid(visible=False)
    cut = [error(his, float(p), 0.4) for p in psi]
    right.plot(psi, cut, color=BASE, label="paper")
    right.plot(psi[::5], [abs(0.4 * tan(float(p))) for p in psi[::5]], ".", color=INK, label="$|v_c \\tan ψ|$")
    right.plot(psi, [error(ours, float(p), 0.4) for p in psi], color=ARM, label="exact")
    limit(right, (-0.6, 0.6), "limits of the workspace", horizontal=False)
    right.set(xlabel="ψ [rad]", ylabel="error [m/s]", title="at $v_c$ = 0.4 m/s", ylim=(-0.01, 0.36))
    legend(right, "upper center", 2)
    worst = error(his, 0.6, 0.4)
    return Section(
        "distortion",
        "What the paper does not show: distortion",
        [
            "Beyond the limit the base has everything, and drives v_c/cos ψ so that the hand's motion along r is right. "
            "The same drive moves the hand sideways by v_c tan ψ, and nothing takes that back: at the edge of the "
            f"workspace (ψ = 0.6 rad) {worst:.2f} m/s of 0.4, {100 * worst / 0.4:.0f} %. The dots are the formula. "
            f"With <code>exact</code> the error is {zero:.0e} m/s everywhere on this map, with the same blend: the arm closes what the base leaves."
        ],
        [lab.picture("distortion", figure, "Error of the hand's velocity with the paper's law over bearing and speed")],
    )
