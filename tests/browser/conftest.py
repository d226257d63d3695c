"""A real Chromium on the real page of real processes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import pytest
from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Page

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
def page(context: BrowserContext, cockpit: Cockpit) -> Page:
    return cockpit.watch(context.new_page())
