"""Gamepads as browsers really show them: phantoms, frozen entries, unknown layouts, worn sticks."""

from __future__ import annotations

import json
from typing import Any

import pytest
from playwright.sync_api import BrowserContext, Page

from tests.browser.conftest import Cockpit
from tests.browser.hands import arm
from tests.processes import until

pytestmark = [pytest.mark.browser, pytest.mark.real_time]
FULL = 0.4
DEAD = 0.24

FAKE = """
    window.pads = [];
    window.make = (index, more = {}) => pads[index] = {
        index, id: `Pad ${index} (STANDARD GAMEPAD Vendor: 045e Product: 028e)`, connected: true, mapping: "standard",
        timestamp: 0, axes: [0, 0, 0, 0],
        buttons: Array.from({length: 17}, () => ({pressed: false, touched: false, value: 0})), ...more};
    window.put = (index, x, y) => Object.assign(pads[index].axes, [x, y]);
    window.down = (index, button, is = true) => pads[index].buttons[button].pressed = is;
    const seen = (pad) => (pad?.connected ? structuredClone(pad) : null);
    navigator.getGamepads = () => [0, 1, 2, 3].map((index) => seen(pads[index]));
"""


class Pads:
    """The fake pads of one page."""

    def __init__(self, page: Page) -> None:
        self.page = page

    def make(self, index: int, **more: Any) -> None:
        """Connect a pad, or another in its place."""
        self.page.evaluate(f"void make({index}, {json.dumps(more)})")
        self.seen(f"overreach.gamepads.pads.get({index})?.id === pads[{index}].id")

    def seen(self, what: str) -> None:
        """Wait until the page has looked."""
        self.page.wait_for_function(f"() => {what}", polling=10)

    def put(self, index: int, x: float, y: float) -> None:
        """Move its left stick: x right, y up."""
        self.page.evaluate(f"void put({index}, {x}, {-y})")
        if self.page.evaluate(f"pads[{index}].mapping") == "standard":
            known = f"overreach.gamepads.pads.get({index})"
            self.seen(f"{known}.x === {x} && {known}.y === {y}")
        self.page.wait_for_timeout(40)

    def press(self, index: int, button: int) -> None:
        self.page.evaluate(f"down({index}, {button})")
        self.seen(f"overreach.gamepads.pads.get({index}).down[{button}]")

    def lift(self, index: int, button: int) -> None:
        self.page.evaluate(f"down({index}, {button}, false)")
        self.seen(f"!overreach.gamepads.pads.get({index}).down[{button}]")

    def shows(self, axis: int, to: int) -> None:
        """Push an axis and let go, each as soon as the page that asks for it has seen it."""
        step = self.page.evaluate("overreach.gamepads.asking.step")
        self.page.evaluate(f"void (pads[0].axes[{axis}] = {to})")
        self.seen("overreach.gamepads.asking.moved")
        self.page.evaluate(f"void (pads[0].axes[{axis}] = 0)")
        self.seen(f"overreach.gamepads.asking.step === {step + 1}")

    def said(self) -> str:
        """What the page says of them."""
        self.page.wait_for_timeout(250)
        return self.page.inner_text("#inputs")


@pytest.fixture
def pads(context: BrowserContext, cockpit: Cockpit) -> Pads:
    page = context.new_page()
    page.add_init_script(FAKE)
    return Pads(cockpit.watch(page))


def test_the_live_pad_counts(pads: Pads, cockpit: Cockpit) -> None:
    """A phantom in slot 0 and a frozen old entry beside the pad that came back neither drive nor are in the way."""
    page, observer = pads.page, cockpit.observer
    arm(page, observer)
    pads.make(0, id="A keyboard that says it is a pad", mapping="", axes=[-1, 1, 0.5, 0])
    pads.make(1, axes=[0.0, 0.0, -1, -1])
    pads.put(1, 0.0, 1.0)
    until(lambda: observer.now.twist.v_x == pytest.approx(FULL), what="the live pad")
    assert "drives" in pads.said()
    pads.make(2)  # the same pad, unplugged and plugged in again: the old entry is still there, and still full ahead
    pads.put(2, 0.0, 0.9)
    until(lambda: observer.speed() == 0.0, what="the doubt")
    page.wait_for_timeout(200)
    assert observer.speed() == 0.0
    pads.put(2, 0.0, 0.0)
    pads.put(2, 0.0, -1.0)
    until(lambda: observer.now.twist.v_x == pytest.approx(-FULL), what="the pad that came back")
    pads.put(2, 0.0, 0.0)
    until(lambda: observer.speed() == 0.0, what="its release")
    page.wait_for_timeout(200)
    assert observer.speed() == 0.0  # the frozen entry, still full ahead, moves nothing
    assert cockpit.errors == []


def test_any_pads_stop(pads: Pads, cockpit: Cockpit) -> None:
    """Stop of any pad stops, not only that of the first or of the one that drives."""
    page, observer = pads.page, cockpit.observer
    for index in range(4):
        pads.make(index)
    for index in range(4):
        arm(page, observer)
        pads.put(0, 0.0, 1.0)
        until(lambda: observer.speed() > 0.3, what="motion")
        since = observer.now.t
        pads.press(index, 1)
        until(lambda: observer.now.stopped, 5.0, f"the stop of pad {index}")
        assert observer.stop_time(since) <= observer.welcome.stop_time + 0.1  # until the call arrives
        pads.lift(index, 1)
        pads.put(0, 0.0, 0.0)
    arm(page, observer)
    page.evaluate("pads.length = 0")
    page.wait_for_timeout(100)
    page.evaluate("make(3); down(3, 1)")  # browsers show a pad only at its first press: here that is Stop
    until(lambda: observer.now.stopped, 5.0, "the stop that made the pad seen")


def test_worn_sticks(pads: Pads, cockpit: Cockpit) -> None:
    """A stick that rests at 0.13, or anywhere below the dead zone, is released; from there on it is smooth."""
    page, observer = pads.page, cockpit.observer
    arm(page, observer)
    pads.make(0)
    for rest in (0.13, 0.2, 0.23):
        pads.put(0, 0.0, 1.0)
        until(lambda: observer.now.twist.v_x == pytest.approx(FULL), what="full deflection")
        pads.put(0, rest, 0.0)
        until(lambda: observer.speed() == 0.0, what=f"the release at {rest}")
        assert not page.evaluate("overreach.stick.held")
    pads.put(0, 0.0, 0.3)
    for size in (0.3, 0.26, 0.245, 0.5, 0.8):
        pads.put(0, 0.0, size)
        r = (size - DEAD) / (1 - DEAD)
        wish = FULL * (0.3 * r + 0.7 * r**3)
        until(lambda wish=wish: abs(observer.now.twist.v_x - wish) < 1e-4, 5.0, f"{wish} at {size}")  # type: ignore[misc]  # bound in a loop
    pads.put(0, 0.0, 0.0)
    pads.make(1, axes=[1, -1, 1, 1])  # full before its first use
    page.wait_for_timeout(200)
    assert observer.speed() == 0.0
    assert "centre first" in pads.said()
    pads.put(1, 0.0, 0.0)
    pads.put(1, 1.0, 0.0)
    until(lambda: observer.now.twist.v_y == pytest.approx(-FULL), what="the stick after its centre")
    pads.put(1, 0.0, 0.0)
    until(lambda: observer.speed() == 0.0, what="the release")
    page.evaluate("document.hasFocus = () => false")  # another window has it: this stick may be moved for that one
    pads.put(1, 0.0, 1.0)
    page.wait_for_timeout(200)
    assert observer.speed() == 0.0


def test_unknown_layouts(pads: Pads, cockpit: Cockpit) -> None:
    """A pad without a known layout does not arm or drive; any button of it stops; shown once, its layout is kept."""
    page, observer = pads.page, cockpit.observer
    pads.make(0, id="054c-09cc-Wireless Controller", mapping="")
    said = pads.said()
    assert "Wireless Controller" in said
    assert "does not drive" in said
    pads.press(0, 9)  # on this one the stick's own button
    page.wait_for_timeout(200)
    assert not observer.now.armed
    until(lambda: observer.now.stopped, what="the stop")
    pads.lift(0, 9)
    for button in (0, 2, 13):
        arm(page, observer)
        pads.press(0, button)
        until(lambda: observer.now.stopped, 5.0, f"the stop by button {button}")
        pads.lift(0, button)
    arm(page, observer)
    pads.put(0, 0.0, 1.0)
    page.wait_for_timeout(200)
    assert observer.speed() == 0.0
    pads.put(0, 0.0, 0.0)

    page.click("#pads button")
    assert "forward" in pads.said()
    pads.shows(3, -1)  # forward is its axis 3, to the right its axis 2
    assert "right" in pads.said()
    pads.shows(2, 1)
    for word, button in (("stop", 2), ("arm", 8), ("dead-man", 6)):
        assert word in pads.said()
        pads.press(0, button)
        pads.lift(0, button)
    assert "ready" in pads.said()
    assert not observer.now.stopped  # while it was asked for, its buttons were answers
    page.reload()
    page.wait_for_function("window.overreach?.page.state")
    pads.make(0, id="054c-09cc-Wireless Controller", mapping="")
    pads.press(0, 8)
    until(lambda: observer.now.armed, what="armed by its own button")
    pads.lift(0, 8)
    page.evaluate("void (pads[0].axes[3] = -1)")
    until(lambda: observer.now.twist.v_x == pytest.approx(FULL), what="its own forward")
    pads.press(0, 2)
    until(lambda: observer.now.stopped, what="its own stop")
    page.evaluate("localStorage.clear()")
    assert cockpit.errors == []


def test_a_held_button_as_dead_man(pads: Pads, cockpit: Cockpit) -> None:
    """With the setting, the stick moves nothing without the button, whose release stops; this browser keeps it."""
    page, observer = pads.page, cockpit.observer
    arm(page, observer)
    pads.make(0)
    page.click('#deadman [data-value="button"]')
    pads.put(0, 0.0, 1.0)
    page.wait_for_timeout(200)
    assert observer.speed() == 0.0
    pads.put(0, 0.0, 0.0)
    pads.press(0, 5)
    page.wait_for_timeout(150)
    assert observer.speed() == 0.0
    pads.put(0, 0.0, 1.0)
    until(lambda: observer.now.twist.v_x == pytest.approx(FULL), what="stick and button")
    pads.lift(0, 5)
    until(lambda: observer.speed() == 0.0, what="the button's release")
    pads.press(0, 4)
    until(lambda: observer.now.twist.v_x == pytest.approx(FULL), what="the other button")
    page.evaluate("dispatchEvent(new Event('blur'))")
    until(lambda: observer.speed() == 0.0, what="the window left")
    page.wait_for_timeout(200)
    assert observer.speed() == 0.0  # the button is still held: it must come up first
    pads.make(1, axes=[-1, -1, -1, -1])  # full before its first use
    pads.press(1, 4)
    page.wait_for_timeout(200)
    assert observer.speed() == 0.0
    pads.lift(1, 4)
    page.reload()
    page.wait_for_function("window.overreach?.page.state")
    assert page.get_attribute('#deadman [data-value="button"]', "aria-pressed") == "true"
    page.evaluate("localStorage.clear()")


def test_where_there_is_none(context: BrowserContext, cockpit: Cockpit) -> None:
    """Without a pad the page says what to do; where the browser hides them, why; a stuck arm button arms nothing."""
    page = cockpit.watch(context.new_page())
    until(lambda: "press a button on it" in page.inner_text("#pads-none"), what="the words")
    page.add_init_script("delete Navigator.prototype.getGamepads")
    page.reload()
    page.wait_for_function("window.overreach?.page.state")
    until(lambda: "knows no gamepads" in page.inner_text("#pads-none"), what="the words")
    page.add_init_script("Object.defineProperty(window, 'isSecureContext', {value: false})")
    page.reload()
    page.wait_for_function("window.overreach?.page.state")
    until(lambda: "by https" in page.inner_text("#pads-none"), what="the reason")
    page.close()
    page = context.new_page()
    page.add_init_script(FAKE + "make(0); down(0, 9);")
    cockpit.watch(page)
    page.wait_for_timeout(300)
    assert not cockpit.observer.now.armed
    page.evaluate("down(0, 9, false)")
    page.wait_for_timeout(60)
    page.evaluate("down(0, 9)")
    until(lambda: cockpit.observer.now.armed, what="a press of it")
