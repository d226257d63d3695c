from __future__ import annotations

import json
import math
import re
import xml.etree.ElementTree as ET
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from matplotlib import pyplot as plt
from playwright.sync_api import Browser

from docs.headline import BEGIN, END
from overreach import look
from overreach.errors import SetupError
from overreach.reproduce import chatter, lab, run
from overreach.reproduce.words import number

EXACT = 1e-12
FIGURES = {"blending", "arbitrary", "rivals", "cost", "creep", "distortion", "straight", "chatter"} | {
    f"scenario_{name}" for name in ("outward", "inward", "left", "right")
}


@pytest.fixture(scope="module")
def physics(report: Path) -> dict[str, Any]:
    """What results.json says of physics."""
    found: dict[str, Any] = json.loads((report / "results.json").read_text())["physics"]
    return found


def test_all_is_written(report: Path) -> None:
    """A page, results, every figure as SVG and PNG, every run as CSV with numbers in every line."""
    assert {entry.name for entry in report.iterdir()} == {
        "report.html", "headline.md", "results.json", "figures", "data",
    }  # fmt: skip
    wanted = {f"{name}.{kind}" for name in FIGURES for kind in ("svg", "png")}
    assert {entry.name for entry in (report / "figures").iterdir()} == wanted
    for name in FIGURES:
        assert ET.parse(report / "figures" / f"{name}.svg").getroot().tag.endswith("svg")
        assert (report / "figures" / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    tables = list((report / "data").iterdir())
    assert len(tables) > 30
    for table in tables:
        header, *lines = table.read_text().splitlines()
        assert len(lines) > 10
        assert all(line.count(",") == header.count(",") for line in lines)
        assert "nan" not in table.read_text()


@pytest.mark.parametrize(
    ("draw", "says"),
    [
        (lambda one, two: one.plot([0, 1]) and None, "a panel is empty"),
        (lambda one, two: [axes.plot([0, 1]) and axes.set_xlabel("t") for axes in (one, two)], "without its unit"),
        (lambda one, two: [axes.plot([0, 1]) and axes.set_xlabel("t [s]") for axes in (one, two)], "no ylabel"),
        (lambda one, two: [axes.plot([0, 1]) and axes.set_ylabel("l [m]") for axes in (one, two)], "no xlabel"),
    ],
    ids=["empty", "unit", "ylabel", "xlabel"],
)
def test_a_figure_nobody_should_see_is_an_error(draw: Any, says: str) -> None:
    """An empty panel, a label without its unit or no label at all stops the report; every figure passes this."""
    figure, ((one, two),) = look.panels(1, 2)
    draw(one, two)
    with pytest.raises(ValueError, match=says):
        look.check("some", figure)
    plt.close(figure)


def test_blends_are_as_wide_as_they_say(physics: dict[str, Any]) -> None:
    """From 1 % to 99 % is ln 99/alpha; a smoothstep is exactly 0 and 1 at the ends of its band."""
    found = physics["blending"]
    for sharp, width in found["width_1_to_99_percent"].items():
        assert width == pytest.approx(math.log(99.0) / float(sharp))
    assert found["mu_at_limit"] == 0.5
    assert found["mu_half_a_width_beyond"] == pytest.approx(0.99)
    assert found["smoothstep_at_its_ends"] == [0.0, 1.0]


@pytest.mark.parametrize("name", ["outward", "inward", "left", "right"])
def test_scenarios_follow_the_closed_form(physics: dict[str, Any], name: str) -> None:
    """Straight through a limit the paper's law follows Wright's omega, is true, and `exact` does the very same."""
    found = physics["scenarios"][name]
    assert found["closed_form_error_max"] < 1e-4
    assert found["exact_differs_from_paper_by"] < EXACT
    assert found["ee_error_max"] < EXACT
    assert found["ends_inside"]
    assert found["authority_changes"] >= 3
    assert (found["base_travel"] > 1.0) == (name in ("outward", "inward"))


def test_exact_is_exact_where_the_paper_is_not(physics: dict[str, Any]) -> None:
    """On the arbitrary drive the hand does what it is told with `exact`, and not with `paper`."""
    found = physics["arbitrary"]
    assert found["exact"]["ee_error_max"] < EXACT
    assert found["exact"]["ee_path_error"] < EXACT
    assert found["paper"]["ee_error_max"] > 0.2
    assert found["paper"]["ee_path_error"] > 0.1


def test_distortion_is_what_the_formula_says(physics: dict[str, Any]) -> None:
    """The paper's error is mu |v_c tan psi| everywhere on the map; that of `exact` is rounding."""
    found = physics["distortion"]
    assert found["paper_differs_from_formula_by"] < EXACT
    assert found["paper_at_0.4_and_0.6"] == pytest.approx(0.4 * math.tan(0.6), rel=1e-4)
    assert found["exact_worst"] < EXACT


def test_a_reach_moves_no_base(physics: dict[str, Any]) -> None:
    """For 10 cm inside the workspace the base stays where it is with the sharing laws; the peers drive it."""
    found = physics["rivals"]["reach"]
    for name in ("exact", "paper", "switch", "separate"):
        assert found[name]["base_travel"] == found[name]["base_turn"] == 0.0
        assert found[name]["hand_travel"] == pytest.approx(0.1, abs=1e-6)
    assert found["qp"]["base_travel"] == pytest.approx(0.09, abs=0.01)
    for name in ("weighted", "holistic"):
        assert found[name]["base_travel"] > 0.03


def test_rivals_are_measured_alike(physics: dict[str, Any]) -> None:
    """In one frame and on one stick: `exact` is exact and stays by its workspace; each rival lacks one of the two."""
    found = physics["rivals"]["mixed"]
    assert len(found) == 7
    ours = found["exact"]
    assert ours["ee_error_max"] < EXACT
    assert max(ours["outside_l"], ours["outside_psi"]) < 0.06
    for name in ("paper", "switch", "separate", "qp", "holistic"):
        assert found[name]["ee_error_max"] > 1e-3
    assert found["weighted"]["ee_error_max"] < 1e-6  # the pseudo-inverse is exact, too, but knows no workspace
    assert found["weighted"]["outside_psi"] > 0.3


def test_a_dearer_base_drives_less(physics: dict[str, Any]) -> None:
    """The weight of the pseudo-inverse trades base travel for nothing: it falls with the weight, never to zero."""
    reach = [one["reach"] for one in physics["rivals"]["weights"].values()]
    assert reach == sorted(reach, reverse=True)
    assert reach[-1] > 0.0


def test_tanh_creeps_and_smoothstep_does_not(physics: dict[str, Any]) -> None:
    """Beyond the limit tanh goes on as ln(1 + 2 alpha v t)/(2 alpha); smoothstep stays within half its width."""
    found = physics["creep"]
    for t in (60.0, 600.0):
        formula = math.log1p(2.0 * 50.0 * 0.4 * (t - 0.5)) / 100.0
        assert found["tanh_50"][f"beyond_at_{t:.0f}_s"] == pytest.approx(formula, abs=1e-3)
        assert found["smoothstep"][f"beyond_at_{t:.0f}_s"] <= 0.05 + EXACT
    assert found["tanh_10"]["beyond_at_60_s"] == pytest.approx(0.15, abs=1e-3)  # the arm is straight


@pytest.mark.parametrize("way", ["forward", "reverse"])
def test_straight_stays_straight(physics: dict[str, Any], way: str) -> None:
    """Sent straight ahead with the arm 0.4 rad aside, `exact` goes there and lines up; `paper` goes along the base."""
    ours, his = physics["straight"][f"exact_{way}"], physics["straight"][f"paper_{way}"]
    assert abs(ours["direction_off"]) < 1e-3
    assert ours["off_the_line_max"] < 1e-3
    assert abs(ours["psi_end"]) < 1e-2
    assert abs(his["direction_off"]) == pytest.approx(0.4, abs=0.02)
    assert abs(his["psi_end"]) == pytest.approx(0.4, abs=0.01)


def test_blends_do_not_chatter(physics: dict[str, Any]) -> None:
    """Trembling at the corner, with noise and lag, the hard switch flips several times a second, no blend ever."""
    found = physics["chatter"]["dither"]
    assert found["switch"]["flips_per_s"] > 2.0
    assert all(one["flips_per_s"] == 0.0 for name, one in found.items() if name != "switch")
    pushed = physics["chatter"]["dither_pushed"]
    assert pushed["switch"]["variation_asked_per_s"] > 2.0 * pushed["exact_smoothstep"]["variation_asked_per_s"]


def test_every_parameter_says_whose_it_is(physics: dict[str, Any]) -> None:
    """Each parameter has a value and says whether it is the paper's or ours."""
    rows = physics["parameters"]
    assert len(rows) > 20
    assert all(row["name"] and row["value"] and row["from"] for row in rows)


def test_the_same_seed_gives_the_same_bytes(report: Path, tmp_path: Path) -> None:
    """Noise is seeded: run again, the CSVs are the same to the byte."""
    chatter.section(lab.Lab(tmp_path))
    tables = list((tmp_path / "data").iterdir())
    assert len(tables) == 8
    for table in tables:
        assert table.read_bytes() == (report / "data" / table.name).read_bytes()


def test_the_readme_shows_what_the_command_found(report: Path) -> None:
    """The README's table is that of the command: every line of physics is the same, cell by cell."""
    _, _, rest = (Path(__file__).parents[2] / "README.md").read_text().partition(BEGIN)
    shown = rest.partition(END)[0].strip().splitlines()
    found = (report / "headline.md").read_text().strip().splitlines()
    assert len(shown) == len(found) == 9
    assert shown[:-1] == found[:-1]
    assert shown[-1].partition("]")[0] == found[-1].partition("]")[0]  # what was timed is another day's


def test_timing_is_there_and_says_where_it_was_measured(report: Path) -> None:
    """Timing stands apart from physics, with machine, versions, every solver, and the ratios."""
    timing = json.loads((report / "results.json").read_text())["timing"]
    assert timing["machine"]["python"]
    assert {f"qp, {name}" for name in ("daqp", "quadprog", "piqp", "proxqp", "osqp", "clarabel", "daqp-direct")} <= set(
        timing["steps_us"]
    )
    assert {"fastest_qp", "default_qp"} <= set(timing["ratios"])


def hear(heard: list[str], what: str, event: Any) -> None:
    heard.append(getattr(event, what))


@pytest.mark.browser
@pytest.mark.parametrize(("width", "scheme"), [(1280, "light"), (390, "dark")], ids=["desk", "phone"])
def test_the_report_opens_offline(browser: Browser, report: Path, width: int, scheme: str) -> None:
    """The report asks for nothing but itself, logs nothing, has every section and figure, and fits the screen."""
    text = (report / "report.html").read_text()
    assert not re.search(r"(src|href)=\"(?!#)", text)
    context = browser.new_context(viewport={"width": width, "height": 800}, offline=True)
    page = context.new_page()
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    heard: list[str] = []
    page.on("console", partial(hear, heard, "text"))
    page.on("request", partial(hear, heard, "url"))
    page.goto(f"file://{report / 'report.html'}")
    assert heard == [f"file://{report / 'report.html'}"]
    assert page.locator("section[id]").evaluate_all("all => all.map(one => one.id)") == list(run.SECTIONS)
    assert page.locator("figure svg").count() == len(list((report / "figures").glob("*.svg")))
    assert page.evaluate("document.documentElement.scrollWidth") == width
    ids = page.evaluate("[...document.querySelectorAll('[id]')].map(one => one.id)")
    assert len(ids) == len(set(ids))
    drawn = page.locator("figure svg").first.evaluate(
        "one => getComputedStyle(one.querySelector('path[style*=fill]')).fill"
    )
    assert drawn == ("rgb(23, 29, 38)" if scheme == "dark" else "rgb(255, 255, 255)")  # the panel's ground
    context.close()


@pytest.mark.parametrize("where", ["file", "below"])
def test_a_folder_that_cannot_be_is_refused_before_any_work(tmp_path: Path, where: str) -> None:
    """A file in the way, or above the way, is named in one line, and nothing is written."""
    (tmp_path / "file").write_text("mine")
    target = tmp_path / "file" if where == "file" else tmp_path / "file" / "below"
    with pytest.raises(SetupError) as caught:
        run.reproduce(target, progress=False)
    assert "\n" not in str(caught.value)
    assert (tmp_path / "file").read_text() == "mine"


def test_numbers_are_written_for_readers() -> None:
    """Three figures, thousands apart, rounding as 0."""
    assert [number(x) for x in (1e-16, 0.12345, 12.345, 1234.5, -0.5)] == ["0", "0.123", "12.3", "1,234", "-0.5"]
