"""A robot side that is started anew behind a running cockpit: the page shows what is in force now."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import pytest
from playwright.sync_api import BrowserContext, Page

from overreach.link.endpoint import free_port
from overreach.link.messages import Choice
from tests.browser.conftest import Cockpit
from tests.browser.hands import arm
from tests.processes import Half, Observer, half, until

pytestmark = [pytest.mark.browser, pytest.mark.real_time]


class Robots:
    """Robot sides at one endpoint, one after the other."""

    def __init__(self, stack: ExitStack) -> None:
        self.endpoint = f"tcp/127.0.0.1:{free_port()}"
        self._stack = stack
        self._running: Half | None = None

    def start(self, *arguments: str) -> Observer:
        """End the one before, if there is one, and start another."""
        if self._running is not None:
            assert self._running.end() == 0
        self._running = self._stack.enter_context(half("robot", "--listen", self.endpoint, *arguments))
        observer = Observer(self.endpoint)
        self._stack.callback(observer.close)
        return observer

    @property
    def side(self) -> Half:
        assert self._running is not None
        return self._running


@pytest.fixture
def robots() -> Iterator[Robots]:
    with ExitStack() as stack:
        yield Robots(stack)


def test_what_is_in_force_now(context: BrowserContext, robots: Robots) -> None:
    """Rate, law, its parameters and the robot's name are those of the robot side that runs, and one drives it."""
    first = robots.start("--rate", "100")
    with half("cockpit", "--connect", robots.endpoint, "--no-browser", "--port", str(free_port())) as running:
        cockpit = Cockpit(running.url(), running, robots.side, first, [], [])
        page: Page = cockpit.watch(context.new_page())
        assert "100 Hz" in page.inner_text("#readout")
        second = robots.start("--rate", "250", "--law", "weighted", "--set", "base_weight=3")
        assert second.welcome.settings.law == Choice("weighted", {"base_weight": 3.0})
        until(lambda: "250 Hz" in page.inner_text("#readout"), what="the other rate")
        assert page.inner_text("#r-stop") == f"{second.welcome.stop_time:.2f} s"
        until(lambda: "weighted" in page.locator("#settings").inner_text(), what="the other law")
        weight = page.locator("#settings .line:has(+ #set-base_weight) .value")
        until(lambda: weight.inner_text() == "3", what="its parameter")
        arm(page, second)
        page.keyboard.down("ArrowUp")
        until(lambda: second.speed() > 0.3, what="motion")
        page.keyboard.up("ArrowUp")
        page.click("#defaults")
        until(lambda: second.link.welcome(5.0).settings == second.welcome.defaults, what="its own defaults")
        third = robots.start("--name", "other")
        until(lambda: "other" in page.inner_text("#readout"), what="the other name")
        arm(page, third)
        page.keyboard.down("ArrowUp")
        until(lambda: third.speed() > 0.3, what="motion of the other")
        page.keyboard.up("ArrowUp")
        until(lambda: third.speed() == 0.0, what="the release")
        assert [error for error in cockpit.errors if "WebSocket" not in error] == []


def test_revisions_do_not_repeat(robots: Robots) -> None:
    """The number of the state of the settings is another after every start: nobody takes one for the other."""
    revisions = [robots.start().welcome.revision for _ in range(3)]
    assert len(set(revisions)) == 3
    assert all(0 <= one < 2**53 for one in revisions)
