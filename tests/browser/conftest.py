"""A real Chromium on the real page of real processes."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import pytest
from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Error, Page

from overreach.link.endpoint import free_port
from overreach.link.messages import Accepted, ConfigureRequest
from overreach.requests import ResetRequest, RestartRequest, StopRequest
from tests.processes import GENEROUS_S, Half, Observer, half, robot, until


@dataclass
class Cockpit:
    """A page, what is behind it, and who watches the robot."""

    url: str
    half: Half
    robot: Half
    observer: Observer
    requests: list[str]
    errors: list[str]

    def _heard(self, said: ConsoleMessage) -> None:
        if said.type == "error":
            self.errors.append(said.text)

    def watch(self, page: Page) -> Page:
        """Keep what the page asks for and what goes wrong in it; open it and wait until it can be used."""
        page.set_default_timeout(GENEROUS_S * 1000)
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", self._heard)
        page.goto(self.url)
        page.wait_for_function("window.overreach?.page.state && window.overreach.link.ready")
        return page


@contextmanager
def running_cockpit(env: dict[str, str] | None = None, *arguments: str) -> Iterator[Cockpit]:
    with robot(env=env) as (endpoint, side, observer):
        port = str(free_port())
        with half("cockpit", "--connect", endpoint, "--no-browser", "--port", port, *arguments) as running:
            yield Cockpit(running.url(), running, side, observer, [], [])


@pytest.fixture
def fresh_cockpit() -> Iterator[Cockpit]:
    """Processes of its own, for a test that ends some."""
    with running_cockpit() as cockpit:
        yield cockpit


@pytest.fixture(scope="session")
def shared_cockpit() -> Iterator[Cockpit]:
    with running_cockpit(None, "--allow-host", "rover.local", "--allow-host", "Rover") as cockpit:
        yield cockpit


@pytest.fixture
def cockpit(shared_cockpit: Cockpit) -> Cockpit:
    """The shared processes, the robot disarmed at its start with the settings that it began with."""
    cockpit, observer = shared_cockpit, shared_cockpit.observer
    assert observer.link.request(StopRequest()) == Accepted()
    until(lambda: observer.now.stopped and observer.speed() == 0.0, what="rest")
    for request in (ResetRequest(), ConfigureRequest(observer.welcome.settings)):
        assert observer.link.request(request) == Accepted()
    until(lambda: not observer.now.armed and not observer.now.stopped, what="the reset")
    until(lambda: observer.link.request(RestartRequest()) == Accepted(), what="the start")
    until(lambda: observer.now.pose.x == 0.0, what="the start")
    cockpit.requests.clear()
    cockpit.errors.clear()
    return cockpit


@pytest.fixture
def context(browser: Browser) -> Iterator[BrowserContext]:
    opened = browser.new_context(viewport={"width": 1360, "height": 850})
    yield opened
    opened.close()


@pytest.fixture
def phone(browser: Browser) -> Iterator[BrowserContext]:
    opened = browser.new_context(
        viewport={"width": 390, "height": 844}, is_mobile=True, has_touch=True, device_scale_factor=2
    )
    yield opened
    opened.close()


@pytest.fixture
def fresh_page(context: BrowserContext, cockpit: Cockpit) -> Page:
    """A page that nobody has used."""
    return cockpit.watch(context.new_page())


CLEAN = """() => {
    const { fitness, gamepads, link, page, stick, view } = window.overreach;
    const kept = [...Object.keys(localStorage), ...Object.keys(sessionStorage)];
    const own = kept.some((key) => key.startsWith("overreach"));
    const quiet = link.ready && fitness.good && !stick.held && !page.stopping && !gamepads.pads.size;
    const dark = matchMedia("(prefers-color-scheme: dark)").matches;
    const looks = view.follow && !view.turns && innerWidth === 1360 && innerHeight === 850 && !dark;
    return quiet && looks && !own && !document.querySelector(".q-menu") && document.hasFocus();
}"""
KEYS = ("Shift", "Control", "Alt", "Meta", "ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight")


class Kept:
    """A page that one test after the other uses, as long as it is as it was at first: to load one takes a second."""

    def __init__(self) -> None:
        self.page: Page | None = None
        self._settings = ""

    def again(self) -> Page | None:
        """Return the page, ready for another test; None if there is none that can be used."""
        page = self.page
        if page is None:
            return None
        now = "JSON.stringify(overreach.page.settings)"
        until(lambda: page.evaluate(now) == self._settings, what="the first settings on the page")
        page.evaluate("overreach.panel.until = 0; overreach.view.clear(); document.activeElement?.blur()")
        until(lambda: page.inner_text("#verdict-word") == "Disarmed", what="the page's news of it")
        return page

    def take(self, page: Page) -> None:
        self.page = page
        self._settings = page.evaluate("JSON.stringify(overreach.page.settings)")

    def give_back(self) -> None:
        """Let go of everything; close the page if it is not as it was at first."""
        page, self.page = self.page, None
        assert page is not None
        with contextlib.suppress(Error):
            page.mouse.up()
            for key in KEYS:
                page.keyboard.up(key)
            page.evaluate("scrollTo(0, 0); document.getElementById('side').scrollTo(0, 0)")
            if page.evaluate(CLEAN):
                self.page = page
                return
            page.context.close()

    def close(self) -> None:
        if self.page is not None:
            self.page.context.close()


@pytest.fixture(scope="session")
def kept(browser: Browser) -> Iterator[Kept]:
    pages = Kept()
    yield pages
    pages.close()


@pytest.fixture
def page(browser: Browser, cockpit: Cockpit, kept: Kept) -> Iterator[Page]:
    """A page, of which nothing is left of the test before."""
    page = kept.again()
    if page is None:
        page = cockpit.watch(browser.new_context(viewport={"width": 1360, "height": 850}).new_page())
        kept.take(page)
    yield page
    kept.give_back()
