"""The wire between cockpit and robot side is cut while a page drives, and joined again."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from playwright.sync_api import BrowserContext, Page

from overreach.link.endpoint import free_port
from tests.browser.hands import arm
from tests.narrow import Narrow, narrow
from tests.processes import Observer, half, robot, until

pytestmark = [pytest.mark.browser, pytest.mark.real_time]


@pytest.fixture
def far(context: BrowserContext) -> Iterator[tuple[Page, Narrow, Observer]]:
    """A page whose cockpit reaches the robot side through a wire that can be bad, and an observer beside the robot."""
    with robot() as (endpoint, _, observer), narrow(int(endpoint.rsplit(":", 1)[1])) as wire:
        connect = f"tcp/127.0.0.1:{wire.port}"
        with half("cockpit", "--connect", connect, "--no-browser", "--port", str(free_port())) as cockpit:
            page = context.new_page()
            page.goto(cockpit.url())
            page.wait_for_function("window.overreach?.page.state && window.overreach.link.ready")
            arm(page, observer)
            page.keyboard.down("ArrowUp")
            until(lambda: observer.speed() > 0.3, what="motion")
            yield page, wire, observer


@pytest.mark.parametrize("seconds", [0.8, 1.5])
def test_the_first_press_after_an_outage_counts(far: tuple[Page, Narrow, Observer], seconds: float) -> None:
    """A release that was lost is told by the idle page, nothing moves by itself, and the first press drives."""
    page, wire, observer = far
    wire.up.cut = True
    page.wait_for_timeout(200)
    page.keyboard.up("ArrowUp")
    page.wait_for_timeout(seconds * 1000)
    assert observer.speed() == 0.0
    wire.up.cut = False
    until(lambda: observer.now.verdict == "released", what="the release")
    assert observer.speed() == 0.0
    page.keyboard.down("ArrowUp")
    until(lambda: observer.speed() > 0.1, 2.0, what="motion by the first press")
    page.keyboard.up("ArrowUp")


def test_a_long_way_is_told_on_the_page(far: tuple[Page, Narrow, Observer]) -> None:
    """Commands that take 0.7 s to the robot side are not obeyed, and the page says how old they are and may be."""
    page, wire, observer = far
    wire.up.delay = 0.7
    until(lambda: observer.now.verdict == "delayed", what="the verdict")
    until(lambda: "s old, 0.4 s are allowed" in page.inner_text("#verdict-reason"), what="the words")
    until(lambda: int(page.inner_text("#r-age").removesuffix(" of 400 ms")) > 600, what="the number")
    until(lambda: observer.speed() == 0.0, what="rest")
    wire.up.delay = 0.0
    page.keyboard.up("ArrowUp")
    until(lambda: observer.now.verdict == "released", what="the release")
    page.keyboard.down("ArrowUp")
    until(lambda: observer.speed() > 0.3, what="motion")
    page.keyboard.up("ArrowUp")
