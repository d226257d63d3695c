from __future__ import annotations

import re
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser

from overreach.experiments.reproduce.run import SECTIONS

pytestmark = pytest.mark.browser


def hear(heard: list[str], what: str, event: Any) -> None:
    heard.append(getattr(event, what))


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
    assert page.locator("section[id]").evaluate_all("all => all.map(one => one.id)") == list(SECTIONS)
    assert page.locator("figure svg").count() == len(list((report / "figures").glob("*.svg")))
    assert page.evaluate("document.documentElement.scrollWidth") == width
    ids = page.evaluate("[...document.querySelectorAll('[id]')].map(one => one.id)")
    assert len(ids) == len(set(ids))
    drawn = page.locator("figure svg").first.evaluate(
        "one => getComputedStyle(one.querySelector('path[style*=fill]')).fill"
    )
    assert drawn == ("rgb(23, 29, 38)" if scheme == "dark" else "rgb(255, 255, 255)")  # the panel's ground
    context.close()
