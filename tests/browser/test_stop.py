"""Stop acts at the press, from every device, whatever else is going on."""

from __future__ import annotations

import pytest
from playwright.sync_api import BrowserContext, Page

from tests.browser.conftest import Cockpit
from tests.browser.hands import Fingers, arm, middle, stopping, top_most
from tests.processes import until

pytestmark = [pytest.mark.browser, pytest.mark.real_time]
PHONES = [(740, 360), (667, 375), (568, 320), (390, 844), (360, 640)]


def test_fingers(phone: BrowserContext, cockpit: Cockpit) -> None:
    """A touch of Stop stops: beside a thumb on the pad, by two fingers, one elsewhere, slipping, held, scrolling."""
    page, observer = cockpit.watch(phone.new_page()), cockpit.observer
    fingers = Fingers(page)
    stop, pad, picture = (middle(page, what) for what in ("#stop", "#pad", "#view"))
    with stopping(page, cockpit, "the other thumb on Stop"):
        fingers.press(1, pad)
        fingers.slide(1, (pad[0], pad[1] - 70))
        until(lambda: observer.speed() > 0.3, what="motion")
        since = observer.now.t
        fingers.press(2, stop)
    assert observer.stop_time(since) <= observer.welcome.stop_time
    fingers.lift()
    with stopping(page, cockpit, "two fingers on Stop"):
        fingers.press(1, (stop[0] - 12, stop[1]))
        fingers.press(2, (stop[0] + 12, stop[1]))
    fingers.lift()
    with stopping(page, cockpit, "a finger that rests elsewhere"):
        fingers.press(1, picture)
        fingers.press(2, stop)
    fingers.lift()
    for slip in (20, 40):
        with stopping(page, cockpit, "a slip off Stop"):
            fingers.press(1, (stop[0], stop[1] + 12))
            fingers.slide(1, (stop[0], stop[1] + 12 + slip))
        fingers.lift()
    with stopping(page, cockpit, "a press that is held"):
        fingers.press(1, stop)
        page.wait_for_timeout(900)  # longer than what browsers take for a long press
    fingers.lift()
    with stopping(page, cockpit, "a second finger while the first scrolls"):
        card = middle(page, "#authority")
        fingers.press(1, card)
        fingers.slide(1, (card[0], card[1] - 60), 8)
        fingers.press(2, middle(page, "#stop"))
    fingers.lift()
    assert cockpit.errors == []


def test_mouse_and_focus(page: Page, cockpit: Cockpit) -> None:
    """Any mouse button on Stop stops at its press; so do Space and Escape at a list, slider or other button."""
    observer = cockpit.observer
    stop = middle(page, "#stop")
    for button in ("left", "right", "middle"):
        page.mouse.move(*stop)
        with stopping(page, cockpit, f"the {button} button"):
            page.mouse.down(button=button)
        page.mouse.move(stop[0], stop[1] + 40)
        page.mouse.up(button=button)
    for key in ("Escape", "Space"):
        slider = page.locator('#set-speed_scale [tabindex="0"]').first
        with stopping(page, cockpit, f"{key} at a slider"):
            slider.focus()
            page.keyboard.press(key)
        with stopping(page, cockpit, f"{key} at a list that is closed"):
            page.locator("#set-law").focus()
            page.keyboard.press(key)
        with stopping(page, cockpit, f"{key} in a list that is open"):
            page.click("#set-law")
            page.locator(".q-menu").wait_for(state="visible")
            page.keyboard.press(key)
        page.keyboard.press("Escape")
        page.locator(".q-menu").wait_for(state="detached")
        with stopping(page, cockpit, f"{key} at another button"):
            page.locator("#theme").focus()
            theme = page.get_attribute("html", "data-theme")
            page.keyboard.press(key)
            assert page.get_attribute("html", "data-theme") == theme
    with stopping(page, cockpit, "Stop beside an open list"):
        page.click("#set-law")
        page.locator(".q-menu").wait_for(state="visible")
        page.mouse.move(*stop)
        page.mouse.down()
    page.mouse.up()
    with stopping(page, cockpit, "Stop under a dialog"):
        page.evaluate(
            """() => {
                const over = document.createElement("div");
                over.id = "over";
                over.className = "q-dialog__backdrop fixed-full";
                over.style = "position: fixed; inset: 0; z-index: 9500; background: #0004";
                document.body.append(over);
            }"""
        )
        assert top_most(page, "#stop")
        page.mouse.down()
    page.mouse.up()
    page.evaluate("document.getElementById('over').remove()")
    with stopping(page, cockpit, "a click without a press, as by who reads the page aloud"):
        page.evaluate("document.getElementById('stop').click()")
    assert observer.speed() == 0.0
    assert cockpit.errors == []


def test_keys_that_say_little_of_themselves(page: Page, cockpit: Cockpit) -> None:
    """Escape and Space of on-screen and remote keyboards stop: by what they write or by where they are."""
    keyboard = Fingers(page)
    for key, code in (("Escape", ""), (" ", ""), ("Unidentified", "Escape"), ("", "Space")):
        with stopping(page, cockpit, repr((key, code))):
            keyboard.key("keyDown", key, code)
        keyboard.key("keyUp", key, code)


def test_arrows_of_an_on_screen_keyboard(page: Page, cockpit: Cockpit) -> None:
    """Arrow keys and letters without a code drive, and their release lets go."""
    observer = cockpit.observer
    arm(page, observer)
    keyboard = Fingers(page)
    for key, part, size in (("ArrowUp", "v_x", 0.4), ("w", "v_x", 0.4), ("A", "v_y", 0.4)):
        keyboard.key("keyDown", key)
        until(lambda part=part, size=size: getattr(observer.now.twist, part) == size, what=key)  # type: ignore[misc]  # bound in a loop
        keyboard.key("keyUp", key.lower() if len(key) == 1 else key)
        until(lambda: observer.speed() == 0.0, what="the release")


def test_stop_is_always_in_view(phone: BrowserContext, cockpit: Cockpit) -> None:
    """On phones, held either way, pad and Stop are on the first screen, and Stop stays when the page is scrolled."""
    page = cockpit.watch(phone.new_page())
    for width, height in PHONES:
        page.set_viewport_size({"width": width, "height": height})
        page.evaluate("scrollTo(0, 0)")
        page.wait_for_timeout(100)
        for what in ("#pad", "#stop", "#arm", "#verdict"):
            assert top_most(page, what), (what, width, height)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        size = page.locator("#pad").bounding_box()
        assert size
        assert size["width"] >= 150, (width, height)
        page.evaluate("scrollTo(0, document.documentElement.scrollHeight)")
        page.wait_for_timeout(100)
        assert page.evaluate("scrollY") > 100
        assert top_most(page, "#stop"), (width, height)
