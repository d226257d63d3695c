"""A hold of the pad or of keys ends when its meaning is in doubt, and the next press works."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from playwright.sync_api import BrowserContext, Page

from overreach.types import Frame
from tests.browser.conftest import Cockpit
from tests.browser.hands import SHIFT, Fingers, arm, middle
from tests.processes import Observer, until

pytestmark = [pytest.mark.browser, pytest.mark.real_time]
FULL = 0.4


@contextmanager
def ended(page: Page, observer: Observer, what: str, press: Callable[[], None]) -> Iterator[None]:
    """Driving forward before; what happens inside ends the hold, at once and for good, and never turns it round."""
    press()
    until(lambda: observer.now.twist.v_x > 0.2, what=f"motion before {what}")
    number = observer.now.tick
    yield
    until(lambda: not page.evaluate("overreach.stick.held"), 5.0, what)
    until(lambda: observer.speed() == 0.0, 5.0, f"standstill after {what}")
    page.wait_for_timeout(150)
    since = [state for state in list(observer.states) if state.tick > number]
    assert min(state.twist.v_x for state in since) >= 0.0, what
    assert observer.speed() == 0.0, what


def test_the_mouse(page: Page, cockpit: Cockpit) -> None:
    """The pad moved or grew, a second button, the first let go in a chord, capture lost, window left, a modifier."""
    observer = cockpit.observer
    arm(page, observer)

    def press() -> None:
        arm(page, observer)
        page.mouse.up()
        x, y = middle(page, "#pad")
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x, y - 60, steps=3)

    def nudge() -> None:
        x, y = middle(page, "#pad")
        page.mouse.move(x + 3, y + 40, steps=3)

    with ended(page, observer, "a window of another size", press):
        page.set_viewport_size({"width": 1000, "height": 640})
        nudge()
    page.set_viewport_size({"width": 1360, "height": 850})
    with ended(page, observer, "a panel that opens", press):
        page.evaluate("document.getElementById('deck').style.bottom = '80px'")
        nudge()
    page.evaluate("document.getElementById('deck').style.bottom = ''")
    with ended(page, observer, "a pad of another size", press):
        page.evaluate("document.getElementById('pad').style.width = '160px'")
    page.evaluate("document.getElementById('pad').style.width = ''")
    with ended(page, observer, "another button", press):
        page.mouse.down(button="right")
        nudge()
    page.mouse.up(button="right")
    with ended(page, observer, "the first of two let go", press):
        page.mouse.down(button="middle")
        page.mouse.up()
        nudge()
    page.mouse.up(button="middle")
    with ended(page, observer, "capture lost", press):
        page.evaluate("document.getElementById('pad').releasePointerCapture(1)")
        nudge()
    with ended(page, observer, "the window left", press):
        page.evaluate("dispatchEvent(new Event('blur'))")
        nudge()
    for key in ("Control", "Alt", "Meta"):
        with ended(page, observer, key, press):
            page.keyboard.down(key)
            nudge()
        page.keyboard.up(key)
    press()
    until(lambda: observer.now.twist.v_x > 0.2, what="motion by the next press")
    page.mouse.up()
    until(lambda: observer.speed() == 0.0, what="the release")
    assert cockpit.errors == []


def test_fingers(phone: BrowserContext, cockpit: Cockpit) -> None:
    """A phone turned, scrolled or zoomed, a touch whose end was never told: let go, and the next touch drives."""
    page, observer = cockpit.watch(phone.new_page()), cockpit.observer
    fingers = Fingers(page)
    arm(page, observer)

    def press(finger: int = 1) -> None:
        arm(page, observer)
        x, y = middle(page, "#pad")
        fingers.press(finger, (x, y))
        fingers.slide(finger, (x, y - 66))

    def nudge() -> None:
        x, y = middle(page, "#pad")
        fingers.slide(1, (x + 3, y + 40))

    with ended(page, observer, "the phone turned", press):
        page.set_viewport_size({"width": 844, "height": 390})
        nudge()
    fingers.lift()
    page.set_viewport_size({"width": 390, "height": 844})
    with ended(page, observer, "the pad scrolled away", press):
        page.evaluate("scrollBy(0, 60)")
        nudge()
    fingers.lift()
    page.evaluate("scrollTo(0, 0)")
    with ended(page, observer, "the page zoomed", press):
        fingers.scale(1.4)
        nudge()
    fingers.lift()
    fingers.scale(1.0)
    with ended(page, observer, "a finger that the page has lost", press):
        page.evaluate("overreach.stick.release()")  # as when the window is left: its end is never told to the pad
    press(2)
    until(lambda: observer.now.twist.v_x > 0.2, what="the next touch, though the first has not ended for the page")
    fingers.slide(1, (30.0, 700.0))
    page.wait_for_timeout(100)
    assert observer.now.twist.v_x > 0.2  # the old finger means nothing any more
    fingers.lift()
    until(lambda: observer.speed() == 0.0, what="the release")
    assert cockpit.errors == []


def test_shift_is_what_the_newest_event_says(page: Page, cockpit: Cockpit) -> None:
    """A quarter of the speed while an event says Shift, full speed while it does not, whatever was missed before."""
    observer = cockpit.observer
    arm(page, observer)
    keys = Fingers(page)

    def speed(of: float) -> None:
        until(lambda: observer.now.twist.v_x == pytest.approx(of * FULL), 5.0, f"{of} of the speed")

    def up() -> None:
        keys.key("keyUp", "ArrowUp", "ArrowUp")
        until(lambda: observer.speed() == 0.0, what="the release")

    keys.key("keyDown", "ArrowUp", "ArrowUp", SHIFT)  # Shift went down elsewhere
    speed(0.25)
    keys.key("keyDown", "ArrowUp", "ArrowUp")  # and came up elsewhere: the key repeats without it
    speed(1.0)
    keys.key("keyDown", "Shift", "ShiftLeft", SHIFT)
    speed(0.25)
    keys.key("keyDown", "Shift", "ShiftRight", SHIFT)
    keys.key("keyUp", "Shift", "ShiftLeft", SHIFT)  # the other is still down
    page.wait_for_timeout(100)
    speed(0.25)
    keys.key("keyUp", "Shift", "ShiftRight")
    speed(1.0)
    up()
    keys.key("keyDown", "Shift", "ShiftLeft", SHIFT)
    page.evaluate("dispatchEvent(new Event('blur'))")  # the window is left: Shift comes up where nobody sees it
    keys.key("keyDown", "ArrowUp", "ArrowUp")
    speed(1.0)
    up()
    page.locator('#set-speed_scale [tabindex="0"]').first.focus()
    keys.key("keyDown", "Shift", "ShiftLeft", SHIFT)  # at a slider
    page.locator("#pad").focus()
    keys.key("keyDown", "ArrowUp", "ArrowUp", SHIFT)
    speed(0.25)
    keys.key("keyUp", "Shift", "ShiftLeft")
    speed(1.0)
    up()
    page.keyboard.down("Shift")
    keys.key("keyDown", "ArrowUp", "ArrowUp", SHIFT)
    speed(0.25)
    page.mouse.move(300, 300)  # a mouse says what its keyboard holds
    page.wait_for_timeout(100)
    speed(0.25)
    page.keyboard.up("Shift")
    speed(1.0)
    up()
    assert cockpit.errors == []


def test_the_curve(page: Page, cockpit: Cockpit) -> None:
    """A pad at r asks for 0.3 r + 0.7 r^3 of the speed, or for what the setting says; keys ask for all or a quarter."""
    observer = cockpit.observer
    arm(page, observer)
    rim = page.locator("#pad").bounding_box()
    assert rim
    radius = rim["width"] / 2 * 76 / 110
    x, y = middle(page, "#pad")
    for expo in (0.7, 0.0):
        if expo != 0.7:
            page.locator("#expo").fill(str(expo))
            page.locator("#pad").focus()
        page.mouse.move(x, y)
        page.mouse.down()
        for r in (0.25, 0.5, 1.0):
            page.mouse.move(x, y - r * radius)
            wish = FULL * ((1 - expo) * r + expo * r**3)
            until(lambda wish=wish: abs(observer.now.twist.v_x - wish) < 2e-3, 5.0, f"{wish} at {r}")  # type: ignore[misc]  # bound in a loop
            assert abs(float(page.inner_text("#out-v")) - wish) < 6e-3
        page.mouse.up()
        until(lambda: observer.speed() == 0.0, what="the release")
    page.reload()
    page.wait_for_function("window.overreach?.page.state")
    assert page.evaluate("overreach.stick.expo") == 0.0  # this browser keeps it
    page.evaluate("localStorage.clear()")


def test_up_is_up_in_the_picture(page: Page, cockpit: Cockpit) -> None:
    """The page commands in its picture's frame: the world's, or by one tap the hand's in a picture that turns."""
    observer = cockpit.observer
    arm(page, observer)

    def arrow() -> float:
        turn = page.get_attribute("#pad-up", "transform") or "rotate(0)"
        return float(turn.removeprefix("rotate(").removesuffix(")"))

    assert observer.welcome.settings.frame is Frame.WORLD
    page.keyboard.down("ArrowLeft")
    until(lambda: observer.now.twist.v_y == FULL and observer.now.frame is Frame.WORLD, what="leftward in the world")
    page.click("#turn")  # in motion: refused, and nothing changes
    until(lambda: "Let go first" in page.inner_text("#verdict-reason"), what="the refusal")
    assert observer.now.twist.v_y == FULL
    until(lambda: observer.now.hand[1] > 0.35, what="the way to the left")
    page.keyboard.up("ArrowLeft")
    until(lambda: observer.speed() == 0.0, what="the release")
    assert page.get_attribute("#turn", "aria-pressed") == "false"
    assert arrow() == 0.0
    page.click('#set-frame button:has-text("hand")')  # the frame alone: the arrow shows what up means in the picture
    until(lambda: abs(arrow()) > 5.0, what="the arrow")
    until(lambda: arrow() == pytest.approx(-57.2958 * observer.now.theta_e, abs=0.3), what="its angle")
    page.click("#turn")
    until(lambda: page.get_attribute("#turn", "aria-pressed") == "true", what="the picture")
    until(lambda: abs(arrow()) < 0.3, what="the arrow upright")
    assert page.evaluate("overreach.view.up") == pytest.approx(observer.now.theta_e, abs=1e-3)
    page.keyboard.down("ArrowUp")
    until(lambda: observer.now.twist.v_x == FULL and observer.now.frame is Frame.HAND, what="forward of the hand")
    page.keyboard.up("ArrowUp")
    until(lambda: observer.speed() == 0.0, what="the release")
    page.mouse.move(*middle(page, "#pad"))
    page.mouse.down()  # a hold that asks for nothing yet
    until(lambda: page.evaluate("overreach.stick.held"), what="the hold")
    page.keyboard.press("t")
    until(lambda: observer.link.welcome(5.0).settings.frame is Frame.WORLD, what="the way back")
    until(lambda: not page.evaluate("overreach.stick.held"), what="the end of a hold whose meaning has changed")
    page.mouse.up()
    until(lambda: page.evaluate("overreach.view.up") == 0, what="the fixed picture")
    assert cockpit.errors == []
