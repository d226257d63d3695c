"""The lever and the keys for the height: they hold like the pad, alone or beside it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page

from overreach.link.endpoint import free_port
from tests.browser.conftest import Cockpit
from tests.browser.hands import Fingers, arm, middle
from tests.processes import Observer, half, robot, until

pytestmark = [pytest.mark.browser, pytest.mark.real_time]


@pytest.fixture(scope="module")
def in_space() -> Iterator[Cockpit]:
    """A robot whose hand goes up and down."""
    with robot("mobile4") as (endpoint, side, observer):
        with half("cockpit", "--connect", endpoint, "--no-browser", "--port", str(free_port())) as running:
            yield Cockpit(running.url(), running, side, observer, [], [])


@pytest.fixture
def touched(browser: Browser, in_space: Cockpit) -> Iterator[Page]:
    context = browser.new_context(viewport={"width": 844, "height": 390}, is_mobile=True, has_touch=True)
    page = in_space.watch(context.new_page())
    arm(page, in_space.observer)
    yield page
    context.close()


def height(observer: Observer) -> float:
    return observer.now.hand[2]


def test_two_thumbs(touched: Page, in_space: Cockpit) -> None:
    """Lever and pad at once move the hand up and along; each that is let go ends its own part, both end the hold."""
    page, observer = touched, in_space.observer
    fingers, most = Fingers(page), observer.welcome.limits
    (x, y), (at, up) = middle(page, "#pad"), middle(page, "#lift .rail")
    began = height(observer)
    fingers.press(1, (at, up))
    fingers.slide(1, (at, up - 60))
    until(lambda: observer.now.twist.v_z > 0.9 * most.v_z, what="the lever")
    assert observer.now.twist.v_x == 0.0
    fingers.press(2, (x, y))
    fingers.slide(2, (x, y - 50))
    until(lambda: observer.now.twist.v_x > 0.05, what="the pad beside it")
    assert observer.now.twist.v_z > 0.9 * most.v_z
    until(lambda: height(observer) > began + 0.02, what="the hand is higher")
    fingers.lift(2)
    until(lambda: observer.now.twist.v_x == 0.0, what="the pad is let go")
    assert observer.now.twist.v_z > 0.0
    fingers.lift(1)
    until(lambda: observer.speed() == 0.0 and observer.now.twist.v_z == 0.0, what="rest")
    assert not page.evaluate("overreach.stick.held")
    fingers.press(3, (x, y))
    fingers.slide(3, (x, y + 50))
    until(lambda: observer.now.twist.v_x < -0.05, what="the pad again")
    assert observer.now.twist.v_z == 0.0
    fingers.lift()
    until(lambda: observer.speed() == 0.0, what="rest")
    assert in_space.errors == []


def test_keys_for_the_height(touched: Page, in_space: Cockpit) -> None:
    """E and Q, or Page Up and Down, beside the arrows; Shift is slow; Stop and a window that is left end all of it."""
    page, observer = touched, in_space.observer
    most = observer.welcome.limits.v_z
    for key, sign in (("e", 1.0), ("q", -1.0), ("PageDown", -1.0), ("PageUp", 1.0)):
        page.keyboard.down(key)
        until(lambda sign=sign: sign * observer.now.twist.v_z > 0.9 * most, what=key)  # type: ignore[misc]
        page.keyboard.up(key)
        until(lambda: observer.now.twist.v_z == 0.0, what=f"{key} is let go")
    page.keyboard.down("ArrowUp")
    page.keyboard.down("Shift")
    page.keyboard.down("e")
    until(lambda: 0.0 < observer.now.twist.v_z < 0.3 * most and observer.now.twist.v_x > 0.0, what="slowly, both ways")
    page.keyboard.up("ArrowUp")
    until(lambda: observer.now.twist.v_x == 0.0, what="the arrow is let go")
    assert observer.now.twist.v_z > 0.0
    page.evaluate("window.dispatchEvent(new Event('blur'))")
    until(lambda: observer.now.twist.v_z == 0.0 and observer.speed() == 0.0, what="the window is left")
    page.keyboard.up("e")
    page.keyboard.up("Shift")
    page.keyboard.down("e")
    until(lambda: observer.now.twist.v_z > 0.0, what="again")
    page.keyboard.press("Escape")
    until(lambda: observer.now.stopped, what="the stop")
    page.keyboard.up("e")


def test_a_robot_in_the_plane_has_no_lever(page: Page, cockpit: Cockpit) -> None:
    """Where the hand does not go up and down there is neither lever nor height, and its keys do nothing."""
    assert not page.locator("#lift").is_visible()
    assert not page.locator("#height").is_visible()
    arm(page, cockpit.observer)
    page.keyboard.down("e")
    page.wait_for_timeout(200)
    assert not page.evaluate("overreach.stick.held")
    page.keyboard.up("e")
