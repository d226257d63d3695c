"""Section 7: chattering at the limit: the hard switch against blends, with noise and slow motors."""

from __future__ import annotations

from overreach.law.blend import Smoothstep, Tanh
from overreach.law.body import WholeBody
from overreach.law.laws import Exact, Paper, Switch
from overreach.look import BASE, HAND, panels
from overreach.reproduce.lab import Lab, Section, Table
from overreach.run.metrics import total_variation
from overreach.run.simulate import Run

LAWS: tuple[tuple[str, str, WholeBody], ...] = (
    ("switch", "switch", Switch()),
    ("paper", "paper (tanh)", Paper(blend=Tanh())),
    ("exact_tanh", "exact (tanh)", Exact(blend=Tanh())),
    ("exact_smoothstep", "exact (smoothstep)", Exact(blend=Smoothstep())),
)
SHOWN_S = (0.0, 4.0)
SCENARIOS = {"dither": "trembling at the corner", "dither_pushed": "trembling while pushing outward"}


def section(lab: Lab) -> Section:
    """Run the two tremors with every law; count flips, sum up how the base's speed is changed."""
    runs = {
        (scenario, key): lab.run(scenario, law, f"{scenario}_{key}") for scenario in SCENARIOS for key, _, law in LAWS
    }
    found = {scenario: {key: _numbers(runs[scenario, key]) for key, _, _ in LAWS} for scenario in SCENARIOS}
    lab.physics["chatter"] = found
    shown = (
        ("dither", "switch"),
        ("dither", "exact_smoothstep"),
        ("dither_pushed", "switch"),
        ("dither_pushed", "exact_smoothstep"),
    )
    figure, axes = panels(2, 4, height=1.9, sharex=True, width=9.6)
    for (scenario, key), column in zip(shown, axes.T, strict=True):
        run = runs[scenario, key]
        some = [
            (row, asked) for row, asked in zip(run.rows, run.asked, strict=True) if SHOWN_S[0] <= row.t <= SHOWN_S[1]
        ]
        t = [row.t for row, _ in some]
        column[0].plot(t, [row.mu for row, _ in some], color=HAND, linewidth=0.9)
        column[0].set(ylim=(-0.08, 1.08))
        column[0].set_title(
            f"{key.replace('_', ', ')}\n{'at the corner' if scenario == 'dither' else 'pushing outward'}"
        )
        column[1].plot(t, [asked[0] for _, asked in some], color=BASE, linewidth=0.9)
        most = 0.014 if scenario == "dither" else 0.07
        column[1].set(ylim=(-0.04 * most, most), xlabel="t [s]")
    axes[0][0].set_ylabel("μ, base's share [1]")
    axes[1][0].set_ylabel("$v_b$ asked [m/s]")
    hard, soft = found["dither"]["switch"], found["dither"]["exact_smoothstep"]
    pushed = found["dither_pushed"]
    return Section(
        "chatter",
        "Chattering: the hard switch against blends",
        [
            "The hand starts at the corner of the workspace and trembles by 2 mm and 5 mrad, once a second; the joint "
            "angles are noisy (1 mrad), the motors lag by 50 ms. A flip is a change of authority from arm (share below "
            f"1/4) to base (above 3/4) or back. The hard switch flips {hard['flips_per_s']:.1f} times a second on "
            "average over 20 s, in bursts, most of them at the start: every swing draws the hand a little inward. "
            "A blend's share stays between, so that there is nothing to flip. But its base is never idle: "
            "it takes its part of every swing, so its speed, as it really happens, varies <b>more</b> than the switch's "
            f"({soft['variation_true_per_s']:.4f} against {hard['variation_true_per_s']:.4f} m/s in a second), while what "
            f"is asked of the motors varies less ({soft['variation_asked_per_s']:.4f} against "
            f"{hard['variation_asked_per_s']:.4f}).",
            "Pushing slowly outward, with a tremor twice as fast that reverses the command at every swing, the switch "
            f"asks for jumps: {pushed['switch']['flips_per_s']:.0f} flips and "
            f"{pushed['switch']['variation_asked_per_s']:.2f} m/s in a second. With blends it is "
            f"{pushed['exact_smoothstep']['variation_asked_per_s']:.2f} to {pushed['paper']['variation_asked_per_s']:.2f} "
            f"m/s, and {pushed['exact_smoothstep']['flips_per_s']:.1f} to {pushed['paper']['flips_per_s']:.1f} flips: "
            "mostly the reversals themselves. A command that turns back is the arm's again; the share jumps, but at zero "
            "speed, and no rate does.",
        ],
        [lab.picture("chatter", figure, "Share and commanded base speed under tremor: hard switch and smoothstep")],
        [
            Table(
                f"{title[0].upper() + title[1:]} (scenario <code>{scenario}</code>), 20 s at 200 Hz.",
                (
                    "law",
                    "flips [1/s]",
                    "variation of v_b asked [m/s per s]",
                    "of v_b as it happens [m/s per s]",
                    "beyond in l [m]",
                ),
                [
                    (
                        label,
                        found[scenario][key]["flips_per_s"],
                        found[scenario][key]["variation_asked_per_s"],
                        found[scenario][key]["variation_true_per_s"],
                        found[scenario][key]["outside_l"],
                    )
                    for key, label, _ in LAWS
                ],
            )
            for scenario, title in SCENARIOS.items()
        ],
    )


def _numbers(run: Run) -> dict[str, float]:
    summary = run.summary
    return {
        "flips_per_s": summary.flips_per_s,
        "variation_asked_per_s": total_variation([v_b for v_b, _ in run.asked]) / summary.duration,
        "variation_true_per_s": summary.variation_v_b / summary.duration,
        "outside_l": summary.outside_l,
    }
