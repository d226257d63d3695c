"""A person drives: pointer, finger, keys, gamepad. The robot is watched from outside the page."""

from __future__ import annotations

import math
import signal
import time
from collections.abc import Callable

import pytest
from playwright.sync_api import BrowserContext, CDPSession, Page

from tests.browser.conftest import Cockpit
from tests.processes import Observer, until
from tests.reached import Reached

pytestmark = [pytest.mark.browser, pytest.mark.real_time]


def centre(page: Page) -> tuple[float, float]:
    """Return the middle of the pad."""
    box = page.locator("#pad").bounding_box()
    assert box
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def arm(page: Page, observer: Observer) -> None:
    page.click("#arm")
    until(lambda: observer.now.armed, what="armed")


def words(page: Page) -> str:
    return page.inner_text('[data-share="mu"] .who')


def out_and_back(page: Page, observer: Observer, forward: Callable[[], None], back: Callable[[], None]) -> None:
    """Drive the hand more than 2 m out and back into the arm's reach; the words and the trails must say so."""
    start = observer.now
    assert words(page) == "arm"
    forward()
    until(lambda: words(page) == "blending", what="blending")
    until(lambda: words(page) == "base", what="base")
    until(lambda: observer.now.hand[0] - start.hand[0] > 2.05, what="2 m")
    far = observer.now
    assert far.mu > 0.99
    assert far.pose.x > 1.0
    assert abs(far.hand[1]) < 0.05
    assert page.inner_text("#verdict-word") == "Moving"
    back()
    until(lambda: observer.now.mu == 0.0 and observer.now.v_m < -0.2, what="the arm's turn")
    until(lambda: 0.5 < observer.now.l < 0.8, what="the arm's reach")
    assert words(page) == "arm"
    assert math.dist((start.hand[0], start.hand[1]), (far.hand[0], far.hand[1])) > 2.0


def test_pointer(page: Page, cockpit: Cockpit) -> None:
    """Dragging the pad with the pointer drives the hand out of reach and back, the base taking over between."""
    arm(page, cockpit.observer)
    x, y = centre(page)
    page.mouse.move(x, y)
    page.mouse.down()
    out_and_back(
        page,
        cockpit.observer,
        lambda: page.mouse.move(x, y - 90, steps=6),
        lambda: page.mouse.move(x, y + 90, steps=12),
    )
    page.mouse.up()
    until(lambda: cockpit.observer.speed() == 0.0, what="standstill")
    assert cockpit.errors == []


def test_touch_on_a_phone(phone: BrowserContext, cockpit: Cockpit) -> None:
    """On a phone a finger on the pad does the same; the page does not scroll under it."""
    page = cockpit.watch(phone.new_page())
    arm(page, cockpit.observer)
    x, y = centre(page)
    finger: CDPSession = phone.new_cdp_session(page)

    def touch(kind: str, dy: float | None) -> None:
        points = [] if dy is None else [{"x": x, "y": y + dy}]
        finger.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def slide(to: float) -> None:
        for k in range(1, 7):
            touch("touchMove", to * k / 6)

    touch("touchStart", 0.0)
    out_and_back(page, cockpit.observer, lambda: slide(-85.0), lambda: slide(85.0))
    assert page.evaluate("scrollY") == 0
    touch("touchEnd", None)
    until(lambda: cockpit.observer.speed() == 0.0, what="standstill")
    assert cockpit.errors == []


def test_keyboard(page: Page, cockpit: Cockpit) -> None:
    """The arrow keys drive while they are held; W A S D do the same."""
    page.keyboard.press("Enter")
    until(lambda: cockpit.observer.now.armed, what="armed")

    def back() -> None:
        page.keyboard.up("ArrowUp")
        page.keyboard.down("ArrowDown")

    out_and_back(page, cockpit.observer, lambda: page.keyboard.down("ArrowUp"), back)
    page.keyboard.up("ArrowDown")
    until(lambda: cockpit.observer.speed() == 0.0, what="standstill")
    for key, wish in (("w", (0.4, 0.0)), ("a", (0.0, 0.4)), ("s", (-0.4, 0.0)), ("d", (0.0, -0.4))):
        page.keyboard.down(key)
        until(lambda wish=wish: (cockpit.observer.now.twist.v_x, cockpit.observer.now.twist.v_y) == wish, what=key)  # type: ignore[misc]  # bound in a loop
        page.keyboard.up(key)


FAKE_GAMEPAD = """
    window.fake = {connected: true, mapping: "standard", axes: [0, 0, 0, 0],
                   buttons: Array.from({length: 17}, () => ({pressed: false, value: 0}))};
    navigator.getGamepads = () => [null, window.fake];
"""


def test_gamepad(context: BrowserContext, cockpit: Cockpit) -> None:
    """The left stick of a gamepad drives, Start arms, B stops, and pulling its plug lets go."""
    page = context.new_page()
    page.add_init_script(FAKE_GAMEPAD)
    cockpit.watch(page)
    page.evaluate("fake.buttons[9].pressed = true")
    until(lambda: cockpit.observer.now.armed, what="armed")
    out_and_back(
        page,
        cockpit.observer,
        lambda: page.evaluate("fake.axes[1] = -1"),
        lambda: page.evaluate("fake.axes[1] = 1"),
    )
    page.evaluate("fake.connected = false")
    until(lambda: cockpit.observer.speed() == 0.0, what="standstill")
    assert page.inner_text("#verdict-word") == "Ready"
    page.evaluate("fake.connected = true; fake.buttons[1].pressed = true")
    until(lambda: cockpit.observer.now.stopped, what="the stop")


def test_turning(page: Page, cockpit: Cockpit) -> None:
    """In the hand's frame, left sweeps the hand to the left, past the bearing limit, and the base turns after it."""
    page.click("#turn")
    until(lambda: page.get_attribute("#turn", "aria-pressed") == "true", what="the frame")
    arm(page, cockpit.observer)
    page.keyboard.down("ArrowLeft")
    until(lambda: page.inner_text('[data-share="sigma"] .who') == "base", what="base")
    until(lambda: cockpit.observer.now.pose.yaw > 0.5, what="the base's turn")
    assert cockpit.observer.now.hand[1] > 0.3
    assert cockpit.observer.now.psi <= 0.65 + 1e-9
    page.keyboard.up("ArrowLeft")


def test_diagonals_stay_in_the_circle(page: Page, cockpit: Cockpit) -> None:
    """Two keys at once ask for no more than the pad's rim: both parts shrink alike."""
    arm(page, cockpit.observer)
    page.keyboard.down("ArrowUp")
    page.keyboard.down("ArrowLeft")
    part = 0.4 * math.sqrt(0.5)

    def off() -> float:
        twist = cockpit.observer.now.twist
        return max(abs(twist.v_x - part), abs(twist.v_y - part))

    until(lambda: off() < 1e-6, what="the ramp")
    page.wait_for_timeout(100)
    assert off() < 1e-6
    page.keyboard.up("ArrowUp")
    page.keyboard.up("ArrowLeft")


def at_full_speed(context: BrowserContext, cockpit: Cockpit) -> Page:
    """Return a page that drives straight on."""
    page = cockpit.watch(context.new_page())
    arm(page, cockpit.observer)
    x, y = centre(page)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x, y - 90, steps=4)
    until(lambda: cockpit.observer.speed() > 0.39, what="full speed")
    return page


@pytest.mark.parametrize("way", ["release", "close", "offline", "hidden"])
def test_every_way_of_letting_go_stops_the_robot(
    context: BrowserContext, cockpit: Cockpit, way: str, reached: Reached
) -> None:
    """Release and a closed, hidden or offline page each stop the robot in its `stop_time`."""
    page = at_full_speed(context, cockpit)
    since = time.monotonic()
    if way == "release":
        page.mouse.up()
    elif way == "close":
        page.close()
    elif way == "offline":
        context.set_offline(True)
    else:
        page.evaluate("Object.defineProperty(document, 'hidden', {value: true})")
        since = time.monotonic()
        page.evaluate("document.dispatchEvent(new Event('visibilitychange'))")
    took = cockpit.observer.stop_time(since)
    assert took <= cockpit.observer.welcome.stop_time
    until(lambda: cockpit.observer.speed() == 0.0)
    assert cockpit.robot.process.poll() is None
    reached.say("page closed, hidden, blurred, gamepad unplugged", f"{way}: at rest after {took:.2f} s")


def test_a_killed_cockpit_stops_the_robot(context: BrowserContext, fresh_cockpit: Cockpit, reached: Reached) -> None:
    """The same for a cockpit that ends without a word; the loop goes on."""
    at_full_speed(context, fresh_cockpit)
    observer = fresh_cockpit.observer
    since, tick, overruns = time.monotonic(), observer.now.tick, observer.now.overruns
    fresh_cockpit.half.process.send_signal(signal.SIGKILL)
    took = observer.stop_time(since)
    assert took <= observer.welcome.stop_time
    assert fresh_cockpit.robot.process.poll() is None
    assert observer.now.tick > tick
    missed = observer.now.overruns - overruns
    assert missed <= 20  # of a machine that is busy with ending a browser's page, too
    reached.say("kill -9 of cockpit", f"at rest after {took:.2f} s, {missed} missed ticks")


def test_a_page_that_hangs_stops_the_robot(page: Page, cockpit: Cockpit, reached: Reached) -> None:
    """A page that is busy for seconds sends nothing: 200 ms later the robot ramps, and it stays until a new press."""
    arm(page, cockpit.observer)
    page.keyboard.down("ArrowUp")
    until(lambda: cockpit.observer.speed() > 0.39, what="full speed")
    page.evaluate("setTimeout(() => { const end = Date.now() + 1500; while (Date.now() < end); }, 0)")
    since = time.monotonic()
    took = cockpit.observer.stop_time(since)
    assert took <= cockpit.observer.welcome.stop_time + 0.1  # until the call arrives
    reached.say("slow or stalled page", f"busy for 1.5 s while it drives: at rest after {took:.2f} s")
    until(lambda: cockpit.observer.now.verdict == "regrip", what="the demand for a new press")
    assert cockpit.observer.speed() == 0.0
    page.keyboard.up("ArrowUp")
    page.keyboard.down("ArrowUp")
    until(lambda: cockpit.observer.speed() > 0.3, what="motion after a new press")
    page.keyboard.up("ArrowUp")


def test_nothing_moves_before_arming(fresh_page: Page, cockpit: Cockpit) -> None:
    """A pad that is dragged on a disarmed robot moves nothing, and the page says what to do."""
    assert fresh_page.inner_text("#verdict-word") == "Disarmed"
    assert "Press Arm" in fresh_page.inner_text("#pad-hint")
    x, y = centre(fresh_page)
    fresh_page.mouse.move(x, y)
    fresh_page.mouse.down()
    fresh_page.mouse.move(x, y - 90, steps=4)
    until(lambda: cockpit.observer.now.ack > 5, what="sticks at the robot")
    assert cockpit.observer.speed() == 0.0
    fresh_page.mouse.up()


def test_stop_is_latched_on_the_page(page: Page, cockpit: Cockpit) -> None:
    """Stop, by button or key, stops and holds; Reset moves nothing; Arm and a new press are needed to go on."""
    observer = cockpit.observer
    arm(page, observer)
    for how in ("button", "Escape", "Space", "Control+Escape"):
        page.keyboard.down("ArrowUp")
        until(lambda: observer.speed() > 0.3, what="motion")
        if how == "button":
            page.click("#stop")
        else:
            page.keyboard.press(how)
        until(lambda: observer.now.stopped and observer.speed() == 0.0, what="the stop")
        until(lambda: page.inner_text("#verdict-word") == "Stopped", what="the word")
        assert page.is_disabled("#arm")
        page.click("#reset")
        until(lambda: not observer.now.stopped, what="the reset")
        until(lambda: page.inner_text("#verdict-word") == "Disarmed", what="the word")
        assert observer.speed() == 0.0
        page.keyboard.up("ArrowUp")
        arm(page, observer)
        page.keyboard.down("ArrowUp")
        until(lambda: observer.speed() > 0.1, what="motion")
        page.keyboard.up("ArrowUp")
        until(lambda: observer.speed() == 0.0, what="the release")


def test_two_pages_one_operator(page: Page, context: BrowserContext, cockpit: Cockpit) -> None:
    """The page that armed drives; a second page watches, and may stop the robot. A page that goes disarms."""
    arm(page, cockpit.observer)
    other = cockpit.watch(context.new_page())
    until(lambda: other.inner_text("#verdict-word") == "Watching", what="the word")
    other.keyboard.down("ArrowUp")
    until(lambda: cockpit.observer.now.verdict == "other_operator", what="the refusal")
    assert cockpit.observer.speed() == 0.0
    other.keyboard.up("ArrowUp")
    page.keyboard.down("ArrowUp")
    until(lambda: cockpit.observer.speed() > 0.3, what="the first page's drive")
    other.click("#stop")
    until(lambda: cockpit.observer.now.stopped, what="the stop")
    other.click("#reset")
    arm(other, cockpit.observer)
    other.close()
    until(lambda: not cockpit.observer.now.armed, what="the disarming")


def test_a_reloaded_page_must_press_again(fresh_page: Page, cockpit: Cockpit) -> None:
    """A key that is held while the robot is armed moves nothing: only a press after arming does."""
    fresh_page.keyboard.down("ArrowUp")
    until(lambda: cockpit.observer.now.ack > 3, what="sticks")
    fresh_page.evaluate("overreach.buttons.arm()")
    until(lambda: cockpit.observer.now.verdict == "regrip", what="the demand for a new press")
    assert cockpit.observer.speed() == 0.0
    fresh_page.keyboard.up("ArrowUp")


def test_a_gamepad_that_was_let_go_of_must_come_to_its_centre(context: BrowserContext, cockpit: Cockpit) -> None:
    """A stick that is still tilted after the page has let go does not take hold again by itself."""
    page = context.new_page()
    page.add_init_script(FAKE_GAMEPAD)
    cockpit.watch(page)
    arm(page, cockpit.observer)
    page.wait_for_timeout(100)
    for way in ("blur", "offline", "hidden"):
        page.evaluate("fake.axes[1] = -1")
        until(lambda: cockpit.observer.speed() > 0.39, what="full speed")
        if way == "hidden":
            page.evaluate("Object.defineProperty(document, 'hidden', {value: true})")
            page.evaluate("document.dispatchEvent(new Event('visibilitychange'))")
        else:
            page.evaluate(f"window.dispatchEvent(new Event('{way}'))")
        until(lambda: cockpit.observer.speed() == 0.0, what="standstill")
        page.wait_for_timeout(300)
        assert cockpit.observer.speed() == 0.0
        page.evaluate("fake.axes[1] = 0")
        page.wait_for_timeout(100)


def test_keys_let_go_with_ctrl_or_meta(page: Page, cockpit: Cockpit) -> None:
    """A modifier lets go of all keys, as some systems never tell of keys that come up while it is down."""
    arm(page, cockpit.observer)
    page.keyboard.down("ArrowUp")
    until(lambda: cockpit.observer.speed() > 0.3, what="motion")
    page.keyboard.down("Meta")
    until(lambda: cockpit.observer.speed() == 0.0, what="standstill")
    page.keyboard.up("Meta")
    page.keyboard.up("ArrowUp")


def test_a_stop_outlives_a_lost_connection(page: Page, cockpit: Cockpit) -> None:
    """A stop that is pressed while the page has no connection reaches the robot when it has one again."""
    arm(page, cockpit.observer)
    page.evaluate("overreach.link.socket.close(); overreach.buttons.stop()")
    until(lambda: cockpit.observer.now.stopped, what="the stop")
    page.click("#reset")
    until(lambda: not cockpit.observer.now.stopped, what="the reset")
    arm(page, cockpit.observer)
    page.evaluate("overreach.link.socket.close(); overreach.buttons.stop(); location.reload()")
    until(lambda: cockpit.observer.now.stopped, what="the stop of a page that was loaded anew")
