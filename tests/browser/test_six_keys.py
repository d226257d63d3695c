"""The keys for all six directions of the hand, and for its gripper."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page

from overreach.link.endpoint import free_port
from tests.browser.conftest import Cockpit
from tests.browser.hands import arm
from tests.processes import half, robot, until

pytestmark = [pytest.mark.browser, pytest.mark.real_time]


@pytest.fixture(scope="module", params=["omni7", "omni5", "stretch"])
def in_space(request: pytest.FixtureRequest) -> Iterator[Cockpit]:
    """A robot whose hand turns, and opens and closes."""
    with robot(request.param) as (endpoint, side, observer):
        with half("cockpit", "--connect", endpoint, "--no-browser", "--port", str(free_port())) as running:
            yield Cockpit(running.url(), running, side, observer, [], [])


@pytest.fixture
def open_page(browser: Browser, in_space: Cockpit) -> Iterator[Page]:
    context = browser.new_context(viewport={"width": 1200, "height": 800})
    page = in_space.watch(context.new_page())
    arm(page, in_space.observer)
    yield page
    context.close()


def test_every_direction_has_two_keys(open_page: Page, in_space: Cockpit) -> None:
    """Each key asks for its part of the twist alone, as fast as the robot goes, for as long as it is held."""
    page, observer = open_page, in_space.observer
    limits = observer.welcome.limits
    keys = {
        "w": ("v_x", limits.v_c), "s": ("v_x", -limits.v_c), "a": ("v_y", limits.v_c), "d": ("v_y", -limits.v_c),
        "e": ("v_z", limits.v_z), "q": ("v_z", -limits.v_z), "l": ("w_x", limits.w_c), "j": ("w_x", -limits.w_c),
        "k": ("w_y", limits.w_c), "i": ("w_y", -limits.w_c), "u": ("w_z", limits.w_c), "o": ("w_z", -limits.w_c),
    }  # fmt: skip
    for key, (part, most) in keys.items():
        page.keyboard.down(key)
        until(lambda p=part, m=most: getattr(observer.now.twist, p) / m > 0.95, what=key)  # type: ignore[misc]
        others = {name: getattr(observer.now.twist, name) for name, _ in keys.values() if name != part}
        assert not any(others.values()), (key, others)
        page.keyboard.up(key)
        until(lambda p=part: getattr(observer.now.twist, p) == 0.0, what=f"{key} is let go")  # type: ignore[misc]
    until(lambda: not observer.now.velocity[0], what="rest")
    assert in_space.errors == []


def test_keys_open_and_close_the_gripper(open_page: Page, in_space: Cockpit) -> None:
    """B opens it and G closes it while held, from where it is; then it stays, and the page says how open it is."""
    page, observer = open_page, in_space.observer
    page.keyboard.down("b")
    until(lambda: observer.now.opening > 0.5, what="half open")
    page.keyboard.up("b")
    until(lambda: observer.now.gripper is None, what="let go")
    opened = observer.now.opening
    assert 0.5 < opened <= 1.0
    page.wait_for_timeout(200)
    assert observer.now.opening == opened
    said = page.locator("#r-gripper")
    until(lambda: said.inner_text() == f"{opened * 100:.0f} % open", what="the page says so")
    page.keyboard.down("g")
    until(lambda: observer.now.opening == 0.0, what="closed")
    page.keyboard.up("g")
    assert observer.speed() == 0.0


def test_keys_that_a_robot_has_no_motion_for_do_nothing(page: Page, cockpit: Cockpit) -> None:
    """In the plane nothing rolls, pitches or grips: these keys hold nothing."""
    arm(page, cockpit.observer)
    for key in "ikjlbg":
        page.keyboard.down(key)
        assert not page.evaluate("overreach.stick.held"), key
        page.keyboard.up(key)
    assert not page.locator("#gripper").is_visible()
