"""The results in one small table, in Markdown: what the README shows."""

from __future__ import annotations

from typing import Any

from overreach.reproduce.words import number

LAWS = {
    "exact": "`exact`",
    "paper": "the paper's",
    "separate": "mode button",
    "weighted": "pseudo-inverse",
    "qp": "the paper's QP",
    "holistic": "holistic QP",
}


def headline(results: dict[str, Any]) -> str:
    """Return the table: laws across; what the hand does, what the base does, what it costs."""
    physics, laws = results["physics"], results["timing"]["law_us"]
    mixed, reach = physics["rivals"]["mixed"], physics["rivals"]["reach"]
    rows = {
        "hand's velocity error, rms [m/s]": [mixed[name]["ee_error_rms"] for name in LAWS],
        "the same, greatest [m/s]": [mixed[name]["ee_error_max"] for name in LAWS],
        "hand led off its path [m]": [mixed[name]["ee_path_error"] for name in LAWS],
        "farthest out of the workspace, l [m]": [mixed[name]["outside_l"] for name in LAWS],
        "farthest out of the workspace, ψ [rad]": [mixed[name]["outside_psi"] for name in LAWS],
        "base driven for a 10 cm reach [cm]": [100.0 * reach[name]["base_travel"] for name in LAWS],
        "one decision, called from Python [us]": [laws[f"{name}, plain"]["mean"] for name in LAWS],
    }
    lines = [
        "| | " + " | ".join(LAWS.values()) + " |",
        "|---|" + "---:|" * len(LAWS),
        *(f"| {label} | " + " | ".join(map(number, values)) + " |" for label, values in rows.items()),
    ]
    return "\n".join(lines) + "\n"
