"""Section 1: the blending functions, the paper's Fig. 7."""

from __future__ import annotations

import numpy as np

from overreach.law.blend import LN_99, rise_smoothstep, rise_tanh
from overreach.look import ARM, BASE, HAND, MUTED, limit, panels
from overreach.model.planar import planar
from overreach.reproduce.lab import Lab, Section

SHARP = ((10.0, HAND), (50.0, BASE), (100.0, ARM))
WIDTH = 0.1


def section(lab: Lab) -> Section:
    """Draw mu(l) and sigma(psi) for three sharpnesses, both directions, and the compact blend."""
    space = planar().workspace
    figure, axes = panels(2, 2, height=2.5)
    rows: list[tuple[float, ...]] = []
    widths = {}
    for (name, low, high, unit, symbol), row in zip(
        (("l", space.l_min, space.l_max, "m", "μ"), ("ψ", space.psi_min, space.psi_max, "rad", "σ")), axes, strict=True
    ):
        for end, axis in zip((low, high), row, strict=True):
            outward = end == high
            x = np.linspace(end - 0.35, end + 0.35, 351)
            beyond = x - end if outward else end - x
            for sharp, colour in SHARP:
                y = np.array([rise_tanh(e, sharp) for e in beyond])
                greek, per = ("α", "1/m") if name == "l" else ("β", "1/rad")
                axis.plot(x, y, color=colour, label=f"tanh, {greek} = {sharp:g} {per}")
                width = LN_99 / sharp
                level = {10.0: 0.1, 50.0: 0.5, 100.0: 0.9}[sharp]
                axis.annotate(
                    "", (end - width / 2, level), (end + width / 2, level),
                    arrowprops={"arrowstyle": "|-|", "color": colour, "mutation_scale": 3, "linewidth": 1.0},
                )  # fmt: skip
                words = f"Q = {width:.3f} {unit}"
                if sharp == 10.0:  # the widest: its label stands on its bar
                    at, side = (end + width / 2, "right") if outward else (end - width / 2, "left")
                    axis.text(at, level + 0.03, words, color=colour, fontsize=8, ha=side)
                else:  # on the side where no curve is at this height
                    left = outward and level > 0.5
                    place = end - width / 2 - 0.01 if left else end + width / 2 + 0.01
                    axis.text(
                        place, level, words, color=colour, fontsize=8, va="center", ha="right" if left else "left"
                    )
                widths[f"{sharp:g}"] = width
                if outward and name == "l":
                    rows += [(sharp, float(a), float(b)) for a, b in zip(x, y, strict=True)]
            compact = [rise_smoothstep(e, WIDTH) for e in beyond]
            axis.plot(x, compact, color=MUTED, linestyle="--", label="smoothstep")
            limit(axis, [end], "limit", horizontal=False)
            command = "$v_c$" if name == "l" else "$ω_c$"
            subscript = "max" if outward else "min"
            letter = "L" if name == "l" else "Ψ"
            axis.set(xlabel=f"{name} [{unit}]", ylabel=f"{symbol} (base's share) [1]", ylim=(-0.05, 1.05))
            axis.set_title(f"{command} {'≥' if outward else '<'} 0: around ${letter}_{{{subscript}}}$ = {end:g} {unit}")
    figure.legend(
        handles=axes[0][1].get_legend_handles_labels()[0],
        labels=["tanh, α or β = 10", "tanh, 50", "tanh, 100", f"smoothstep, Q = {WIDTH}", "limit"],
        loc="outside upper center",
        ncols=5,
    )
    lab.data("blending", ("alpha", "l", "mu"), rows)
    lab.physics["blending"] = {
        "width_1_to_99_percent": widths,
        "mu_at_limit": rise_tanh(0.0, 50.0),
        "mu_half_a_width_beyond": rise_tanh(LN_99 / 100.0, 50.0),
        "smoothstep_at_its_ends": [rise_smoothstep(-WIDTH / 2, WIDTH), rise_smoothstep(WIDTH / 2, WIDTH)],
    }
    return Section(
        "blending",
        "Who moves: the blending functions",
        [
            "The base's share of a motion, from 0 (the arm moves) to 1 (the base moves), around the limit that "
            "lies in the direction of the command. Q is the width from 1 % to 99 %: ln 99/α. Going outward the "
            "upper limits count, coming back the lower ones, so that a hand beyond a limit can always return with "
            "the arm. The paper's tanh comes close to 0 and 1 and never gets there; the dashed smoothstep is there "
            "at the ends of its band."
        ],
        [lab.picture("blending", figure, "Blending functions μ(l) and σ(ψ) with their transition widths Q")],
    )
