"""Section 8: every parameter, and whose it is."""

from __future__ import annotations

from overreach.baselines import holistic
from overreach.baselines.qp import PaperQP
from overreach.baselines.solver import SETTINGS
from overreach.law import authority
from overreach.model.planar import planar
from overreach.parameters import schema
from overreach.plugs import BLENDS, blend_plug, law_names, law_plug, names
from overreach.reproduce.lab import Lab, Section, Table
from overreach.run.scenario import builtin_scenarios, load_scenario

PAPER, OURS = "the paper", "ours"
WHOSE = {
    ("smoothstep", "q_l"): "ours: not in the paper",
    ("smoothstep", "q_psi"): "ours: not in the paper",
    (PaperQP.name, "damping"): "ours: the paper gives 0 &lt; λ &lt; 1",
    ("weighted", "base_weight"): "1 is the plain pseudo-inverse; others in section 4",
}
"""Where more is to be said of a parameter than that it is ours."""


def rows() -> list[tuple[str, str, str]]:
    """Return (parameter, value with unit, whose it is), read from where the code has them."""
    robot = planar()
    space, arm, base = robot.workspace, robot.arm, robot.base
    dither = load_scenario("dither")
    found = [
        ("greatest command v_c, ω_c", "0.4 m/s, 0.4 rad/s", PAPER),
        ("workspace L_min, L_max", f"{space.l_min:g} to {space.l_max:g} m", OURS),
        ("workspace Ψ_min, Ψ_max", f"{space.psi_min:g} to {space.psi_max:g} rad", OURS),
        *_described(),
        ("links of the arm", f"{arm.links[0]:g}, {arm.links[1]:g} m", OURS),
        ("shoulder on the base", f"({robot.mount.s_x:g}, {robot.mount.s_y:g}) m", "the paper: the frames coincide"),
        ("start l, ψ", f"{robot.start.l:g} m, {robot.start.psi:g} rad", OURS),
        ("base: v, ω at most", f"{base.v_max:g} m/s, {base.w_max:g} rad/s", OURS),
        ("joints: speed at most", f"{arm.dtheta_max[0]:g}, {arm.dtheta_max[1]:g} rad/s", OURS),
        (
            "QP: q_max", "the robot's speed limits above",
            "ours: the paper gives q_max = 0.01 without a unit; as a rate it could not follow 0.4 m/s",
        ),
        ("QP: tolerances", "; ".join(f"{name} {_plain(values)}" for name, values in SETTINGS.items() if values), "ours: all agree to 1e-4"),
        ("holistic: cost of rates, heading gain", f"{holistic.RATE_COST:g}, {holistic.HEADING_GAIN:g}", "Haviland et al. 2022, published example"),
        (
            "holistic: damper η, ρ_s, ρ_i",
            f"{holistic.DAMPER_GAIN:g} 1/s, {holistic.DAMPER_STOP:g}, {holistic.DAMPER_START:g} rad",
            "Haviland et al. 2022, published example",
        ),
        ("holistic: distance e to the goal", f"|u| times {holistic.LOOK_AHEAD_S:.3g} s", "ours: a stick has no goal; their servo gain is 1.5 1/s"),
        ("exact: the base drives at most", f"{authority.BASE_GAIN:g} times as fast as the hand", "ours"),
        (
            "dither: l, ψ, f", f"{dither.dither.l:g} m, {dither.dither.psi:g} rad, {dither.dither.f:g} Hz", "ours",
        ),
        (
            "dither: noise, lag, seed",
            f"{dither.imperfection.noise:g} rad, {dither.imperfection.lag_s:g} s, {dither.imperfection.seed}", "ours",
        ),
    ]  # fmt: skip
    for name in builtin_scenarios():
        one = load_scenario(name)
        parts = ", ".join(f"{s.t:g} s: ({s.v_c:g}, {s.w_c:g})" for s in one.segments)
        text = f"{one.duration:g} s in steps of {one.dt:g} s; (v_c, ω_c) from {parts}"
        whose = "ours, after the paper's four directions" if name in ("outward", "inward", "left", "right") else "ours"
        found.append((f"scenario <code>{name}</code>", text, whose))
    return found


def _described() -> list[tuple[str, str, str]]:
    """Return the parameters of blends and laws, as their own descriptions have them."""
    plugs = [*map(blend_plug, names(BLENDS)), *map(law_plug, law_names())]
    return [
        (f"{plug.name}: {one.title}", one.shown, WHOSE.get((plug.name, one.name), OURS))
        for plug in plugs
        for one in schema(plug)
    ]


def _plain(values: dict[str, float]) -> str:
    return ", ".join(f"{key} {value:g}" for key, value in values.items())


def section(lab: Lab) -> Section:
    """List every parameter."""
    table = rows()
    lab.physics["parameters"] = [{"name": name, "value": value, "from": whose} for name, value, whose in table]
    return Section(
        "parameters",
        "Every parameter",
        [
            "The paper's equations are reproduced to the letter; its parameter tables are not available to us. What is ours "
            "is said so. Scenarios are TOML files; "
            "<code>overreach simulate FILE --law NAME</code> runs any of them, and your own."
        ],
        [],
        [Table("Parameters, and whose they are.", ("parameter", "value", "from"), table)],
    )
