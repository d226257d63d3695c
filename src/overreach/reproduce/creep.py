"""Section 6a: what a blend that never reaches 1 does in ten minutes."""

from __future__ import annotations

from math import log, log1p

import msgspec

from overreach.law.blend import Blend, Smoothstep, Tanh
from overreach.law.laws import Exact
from overreach.look import ARM, BASE, HAND, INK, STOP, legend, limit, panels, thin
from overreach.reproduce.lab import Lab, Section
from overreach.run.scenario import load_scenario

BLENDS: tuple[tuple[str, Blend, str], ...] = (
    ("tanh_10", Tanh(10.0, 10.0), HAND),
    ("tanh_50", Tanh(50.0, 50.0), BASE),
    ("smoothstep", Smoothstep(0.1, 0.1), ARM),
)


def section(lab: Lab) -> Section:
    """Push outward for ten minutes with tanh and with smoothstep."""
    held = load_scenario("held")
    space, reach = held.model.workspace, held.model.arm.reach[1]
    figure, axes = panels(1, 1, height=3.2)
    axis = axes[0][0]
    found = {}
    for name, blend, colour in BLENDS:
        scenario = msgspec.structs.replace(held, blend=blend)
        run = lab.run(scenario, Exact(blend=blend), f"held_{name}")
        rows = [row for row in run.rows if row.t >= 0.1]
        t, l = [row.t for row in rows], [row.l for row in rows]
        label = f"tanh, α = {blend.k_l:g} 1/m" if blend.name == "tanh" else f"smoothstep, Q = {blend.width_l:g} m"
        # Even in the logarithm of time: as many points in the first second as in the last minutes.
        picked = sorted({min(len(t) - 1, round(10 ** (k / 160 * log(len(t), 10)))) for k in range(161)})
        axis.plot([t[k] for k in picked], [l[k] for k in picked], color=colour, label=label)
        found[name] = {"beyond_at_60_s": l[_at(t, 60.0)] - space.l_max, "beyond_at_600_s": l[-1] - space.l_max}
        if name == "tanh_50":  # with alpha = 10 the arm is straight before the formula holds
            some = [t[k] for k in thin(picked, 20) if t[k] > 3.0]
            e = [space.l_max + log1p(2.0 * blend.k_l * 0.4 * (x - 0.5)) / (2.0 * blend.k_l) for x in some]
            axis.plot(some, e, ".", color=INK, markersize=3.5, label="$L_{max}$ + ln(1 + 2αvt)/(2α)")
    limit(axis, [space.l_max], "$L_{max}$")
    axis.axhline(reach, color=STOP, linewidth=1.4, label="arm straight")
    axis.set(
        xscale="log", xlabel="t [s], pushing outward at 0.4 m/s", ylabel="l [m]", ylim=(0.6, 1.04), xlim=(0.1, 600.0)
    )
    legend(axis, "lower right", 2)
    lab.physics["creep"] = found
    slow, sharp, compact = (found[name] for name, _, _ in BLENDS)
    return Section(
        "creep",
        "What the paper does not show: the arm never stops",
        [
            "tanh never reaches 1, so the arm never quite stops: beyond the limit it goes on as the logarithm of time. "
            f"With α = 50 it is {100 * sharp['beyond_at_60_s']:.1f} cm beyond after a minute and "
            f"{100 * sharp['beyond_at_600_s']:.1f} cm after ten; with α = 10 it is at "
            f"{100 * slow['beyond_at_600_s']:.0f} cm, straight and at the end of its reach (here "
            "the arm stops it, not the law). A smoothstep of about the same width is exactly 1 at the end of its "
            f"band, so that the hand cannot pass it: {100 * compact['beyond_at_600_s']:.1f} cm after ten minutes. "
            "This is the blend's doing, not the law's: both laws take either."
        ],
        [lab.picture("creep", figure, "Length of the arm over ten minutes of pushing outward, logarithmic time")],
    )


def _at(t: list[float], when: float) -> int:
    return min(range(len(t)), key=lambda k: abs(t[k] - when))
