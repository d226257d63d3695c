"""The report as one HTML file: figures inside, nothing fetched, light and dark."""

from __future__ import annotations

import importlib.resources
from typing import Any

from overreach import __version__
from overreach.experiments.reproduce.lab import Picture, Section, Table
from overreach.experiments.reproduce.words import number


def html(sections: list[Section], results: dict[str, Any]) -> str:
    """Return the whole page."""
    style = importlib.resources.files("overreach.experiments.reproduce").joinpath("report.css").read_text("utf-8")
    contents = "".join(f'<li><a href="#{one.key}">{one.title}</a></li>' for one in sections)
    body = "".join(_section(place, one) for place, one in enumerate(sections, start=1))
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>overreach: what the method does, and what the paper's does</title>
<style>
{style}</style>
</head>
<body>
<header>
<p class="mark">overreach {__version__} · reproduce</p>
<h1>Drive a whole mobile manipulator by its hand</h1>
<p class="lead">What the method does, where the paper is right, where it is not, and how both stand against what one
would use instead. Every number on this page was computed or measured by the command that wrote it.</p>
</header>
<section class="claims" aria-label="Claims and findings">
{_claims(results)}
</section>
<nav aria-label="Contents"><ol>{contents}</ol></nav>
{body}
<footer>
<p>The law starts from Kwon et al., “Whole-Body Tele-Operation for Mobile Manipulator Based on Linear and Angular Motion
Decomposition”, Appl. Sci. 2026, 16(2), 712. Figures are in <code>figures/</code> as SVG and PNG, data in
<code>data/</code> as CSV, all numbers in <code>results.json</code>.</p>
</footer>
</body>
</html>
"""


def claims(results: dict[str, Any]) -> list[tuple[str, str, str]]:
    """Return (what the paper says, what is found here, verdict) from the results."""
    found, timing = results["physics"], results["timing"]
    his, ours = found["arbitrary"]["paper"], found["arbitrary"]["exact"]
    formula = max(one["closed_form_error_max"] for one in found["scenarios"].values())
    creep, chatter, reach = found["creep"], found["chatter"]["dither"], found["rivals"]["reach"]
    rows = [
        (
            "Authority passes smoothly at the boundaries",
            f"It does: {chatter['paper']['flips_per_s']:.0f} flips a second under tremor, the hard switch "
            f"{chatter['switch']['flips_per_s']:.1f}; curves as the closed form to {1000 * formula:.2f} mm or mrad",
            "right",
        ),
        (
            "Commands are reproduced without distortion",
            f"In its own model. In true kinematics the hand is wrong by up to {his['ee_error_max']:.2f} m/s of 0.4; "
            f"with <code>exact</code> by {ours['ee_error_max']:.0e} m/s",
            "not so",
        ),
        (
            "The hand stays within its workspace",
            f"It creeps out: {100 * creep['tanh_50']['beyond_at_60_s']:.1f} cm in a minute at α = 50, to the end of the arm "
            f"at α = 10. With smoothstep {100 * creep['smoothstep']['beyond_at_600_s']:.0f} cm, for ever",
            "not so",
        ),
        (
            "A QP drives the base at every instant",
            f"It does: {100 * reach['qp']['base_travel']:.1f} cm of driving for a reach of 10 cm; "
            f"<code>exact</code> {100 * reach['exact']['base_travel']:.0f}",
            "right",
        ),
    ]
    ratios = timing["ratios"]
    speed = f"Plain Python against qpsolvers + quadprog: {ratios['default_qp']['mean']:.0f} times"
    verdict = "right" if ratios["default_qp"]["mean"] >= 35.4 else "less"
    if "fastest_qp" in ratios:
        speed += f"; compiled, against the fastest QP there is ({timing['fastest_qp']}): {ratios['fastest_qp']['mean']:.0f} times"
    rows.append(("35.4 times faster than a QP on average", speed, verdict))
    return rows


def _claims(results: dict[str, Any]) -> str:
    lines = "".join(
        f'<tr><td>{says}</td><td>{finds}</td><td><span class="verdict {verdict.replace(" ", "-")}">{verdict}</span></td></tr>'
        for says, finds, verdict in claims(results)
    )
    return f'<div class="wide"><table><thead><tr><th>The paper says</th><th>Found here</th><th></th></tr></thead><tbody>{lines}</tbody></table></div>'


def _section(place: int, one: Section) -> str:
    words = "".join(f"<p>{text}</p>" for text in one.says)
    return (
        f'<section id="{one.key}"><h2><span>{place}</span> {one.title}</h2>{words}'
        f"{''.join(map(_picture, one.pictures))}{''.join(map(_table, one.tables))}</section>\n"
    )


def _picture(one: Picture) -> str:
    return f'<figure><div class="wide">{one.svg}</div><figcaption>{one.caption}.</figcaption></figure>'


def _table(one: Table) -> str:
    numeric = [all(not isinstance(row[k], str) for row in one.rows) for k in range(len(one.header))]
    head = "".join(
        f'<th class="number">{name}</th>' if right else f"<th>{name}</th>"
        for name, right in zip(one.header, numeric, strict=True)
    )
    lines = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in one.rows)
    return (
        f'<figure><div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{lines}</tbody></table></div>'
        f"<figcaption>{one.caption}</figcaption></figure>"
    )


def _cell(value: str | float) -> str:
    if isinstance(value, str):
        return f"<td>{value}</td>"
    return f'<td class="number">{number(value)}</td>'
