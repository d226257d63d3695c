"""Thin and slow links between page and cockpit: what is let go of stops, what is seen is new or says how old it is."""

from __future__ import annotations

import json
import math
import signal
import time
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import ExitStack

import pytest
from playwright.sync_api import Browser, BrowserContext, Page
from websockets.sync.client import connect

from tests.browser.conftest import Cockpit
from tests.browser.hands import arm, middle
from tests.narrow import Narrow, narrow
from tests.processes import GENEROUS_S, until
from tests.reached import Reached

pytestmark = [pytest.mark.browser, pytest.mark.real_time]
LATE_S = 0.5
STEP_S = 0.1
"""What the test itself may add to a time: one call into a busy browser."""

LISTEN = """
    window.words = [];
    const word = document.getElementById("verdict-word");
    new MutationObserver(() => words.push(word.textContent))
        .observe(word, {childList: true, characterData: true, subtree: true});
"""


@pytest.fixture
def thin(context: BrowserContext, cockpit: Cockpit) -> Iterator[tuple[Page, Narrow]]:
    """A page that has come through a link which is made thin afterwards; it is wide again at the end."""
    with narrow(int(cockpit.url.rpartition(":")[2])) as link:
        own, cockpit.url = cockpit.url, f"http://127.0.0.1:{link.port}"
        try:
            page = cockpit.watch(context.new_page())
        finally:
            cockpit.url = own
        page.evaluate(f"void (() => {{ {LISTEN} }})()")
        yield page, link
        link.up.rate = link.down.rate = math.inf
        page.close()


def stir(page: Page, seconds: float, look: Callable[[], None] = lambda: None) -> int:
    """Move the held pointer about, as fast as the browser takes it; return how often."""
    x, y = middle(page, "#pad")
    end, moves = time.monotonic() + seconds, 0
    while time.monotonic() < end:
        for _ in range(6):
            moves += 1
            page.mouse.move(x + 12 * math.sin(moves / 5), y - 62 + 8 * math.cos(moves / 3))
        look()
    return moves


def press(page: Page) -> None:
    x, y = middle(page, "#pad")
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x, y - 62)


def test_letting_go_through_a_thin_uplink(thin: tuple[Page, Narrow], cockpit: Cockpit) -> None:
    """On 4 to 32 kB/s from page to cockpit, letting go and Stop take `stop_time` and a round trip, not a queue's."""
    (page, link), observer = thin, cockpit.observer
    for rate in (4_000.0, 8_000.0, 32_000.0):
        arm(page, observer)
        link.up.rate = rate
        round_trip = 4 * 220 / rate  # the messages that may be on their way, and one more
        press(page)
        until(lambda: observer.speed() > 0.1, what="motion")
        speeds: list[float] = []
        stir(page, 1.5, lambda: speeds.append(observer.speed()))  # noqa: B023  # called at once
        assert sum(speed == 0.0 for speed in speeds) <= 0.1 * len(speeds)  # it drives throughout
        since = time.monotonic()
        page.mouse.up()
        assert observer.stop_time(since) <= observer.welcome.stop_time + round_trip + STEP_S
        press(page)
        until(lambda: observer.speed() > 0.1, what="motion")
        stir(page, 0.5)
        since = time.monotonic()
        page.keyboard.press("Escape")
        assert observer.stop_time(since) <= observer.welcome.stop_time + round_trip + STEP_S
        until(lambda: observer.now.stopped, what="the stop")
        page.mouse.up()
        link.up.rate = math.inf
    page.wait_for_timeout(500)
    assert not {"View only", "Not done", "No answer"} & set(page.evaluate("words"))


class Mouse:
    """A mouse of any rate: its events go to the browser one after the other, and nothing waits for them."""

    def __init__(self, port: int, page: Page) -> None:
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json", timeout=10) as answer:
            address = next(one["webSocketDebuggerUrl"] for one in json.load(answer) if one["url"].startswith(page.url))
        self._stack = ExitStack()
        self._socket = self._stack.enter_context(connect(address))
        self._id = 0

    def tell(self, kind: str, x: float, y: float, buttons: int) -> None:
        self._id += 1
        button = {"button": "left", "buttons": buttons, "clickCount": 1} if kind != "mouseMoved" or buttons else {}
        event = {"type": kind, "x": x, "y": y, **button}
        self._socket.send(json.dumps({"id": self._id, "method": "Input.dispatchMouseEvent", "params": event}))

    def done(self) -> None:
        """Wait until the browser has taken in all of them."""
        while json.loads(self._socket.recv(GENEROUS_S)).get("id") != self._id:
            pass

    def close(self) -> None:
        self._stack.close()


def test_at_most_sixty_a_second(browser: Browser, debugging_port: int, cockpit: Cockpit) -> None:
    """A mouse of 500 Hz: the page sends at most 60 sticks a second, and the newest of them arrives."""
    observer = cockpit.observer
    page = cockpit.watch(browser.new_page())
    arm(page, observer)
    x, y = middle(page, "#pad")
    mouse = Mouse(debugging_port, page)
    mouse.tell("mouseMoved", x, y, 0)
    mouse.tell("mousePressed", x, y, 1)
    mouse.done()
    page.evaluate("window.raw = 0; document.getElementById('pad').addEventListener('pointerrawupdate', () => raw++)")
    first, since = page.evaluate("overreach.link.seq"), page.evaluate("performance.now()")
    start = time.monotonic()
    for k in range(1500):
        mouse.tell("mouseMoved", x + 20 * math.sin(k / 40), y - 40 - 10 * math.sin(k / 70), 1)
        time.sleep(max(0.0, start + k / 500 - time.monotonic()))
    mouse.done()
    took = (page.evaluate("performance.now()") - since) / 1000
    sticks = page.evaluate("overreach.link.seq") - first
    told = page.evaluate("raw") / took
    assert told > 120.0, f"the pointer told only {told:.0f} times a second"
    assert sticks <= 60.0 * took
    assert sticks > 25.0 * took
    assert page.evaluate("overreach.stick.held")

    def off() -> float:
        wish: float = page.evaluate(
            "overreach.stick.forward"
        )  # anew each time: the browser may not be through with all
        return abs(observer.now.twist.v_x - wish)

    until(lambda: off() < 1e-5, what="the newest")
    mouse.tell("mouseReleased", x, y, 0)
    mouse.done()
    mouse.close()
    until(lambda: observer.speed() == 0.0, what="the release")
    page.close()


def test_a_thin_downlink_drives(thin: tuple[Page, Narrow], cockpit: Cockpit, reached: Reached) -> None:
    """On 20 kB/s from cockpit to page one drives throughout, by pictures at most 0.5 s old; a stop is told as done."""
    (page, link), observer = thin, cockpit.observer
    arm(page, observer)
    link.down.rate = 20_000.0
    page.wait_for_timeout(1500)
    press(page)
    ages: list[float] = []
    slowest: list[float] = []

    def look() -> None:
        t = page.evaluate("overreach.page.state.t")
        ages.append(time.monotonic() - t)  # the robot's clock is this machine's
        slowest.append(observer.speed())

    until(lambda: observer.speed() > 0.2, what="motion")
    stir(page, 3.0, look)
    assert sorted(ages)[int(0.95 * len(ages))] <= LATE_S, ages  # of a machine that is busy with other things, too
    assert max(ages) <= 2 * LATE_S, ages
    assert sum(speed == 0.0 for speed in slowest) <= 0.1 * len(slowest)
    told = float(page.inner_text("#r-delay").removesuffix(" ms"))
    assert told / 1000 == pytest.approx(sorted(ages)[len(ages) // 2], abs=0.15)
    since = time.monotonic()
    page.keyboard.press("Escape")
    assert observer.stop_time(since) <= observer.welcome.stop_time + STEP_S
    page.mouse.up()
    until(lambda: page.inner_text("#verdict-word") == "Stopped", what="the word")
    page.wait_for_timeout(1500)
    assert not {"View only", "Not done", "No answer"} & set(page.evaluate("words"))
    old = sorted(ages)[int(0.95 * len(ages))]
    late = max(s.late_p99 for s in list(observer.states)[-600:]) / 1e3
    reached.say(
        "slow or stalled page",
        f"20 kB/s: pictures {old:.2f} s old (95 %), {max(ages):.2f} s at most; loop late by {late:.2f} ms (p99)",
    )


def test_a_thinner_downlink_shows_only(thin: tuple[Page, Narrow], cockpit: Cockpit) -> None:
    """Where pictures come too late to drive by, the page says so and how late, stays with it, and still stops."""
    (page, link), observer = thin, cockpit.observer
    arm(page, observer)
    press(page)
    until(lambda: observer.speed() > 0.2, what="motion")
    link.down.rate = 1_000.0
    until(lambda: page.inner_text("#verdict-word") == "View only", what="the words")
    until(lambda: observer.speed() == 0.0, what="standstill")
    assert "ms late" in page.inner_text("#verdict-reason")
    assert "View only" in page.inner_text("#pad-hint")
    page.mouse.up()
    page.evaluate("words.length = 0")
    for _ in range(3):
        press(page)
        page.wait_for_timeout(400)
        assert observer.speed() == 0.0
        page.mouse.up()
    assert set(page.evaluate("words")) <= {"View only"}
    page.keyboard.press("Escape")
    until(lambda: observer.now.stopped, 3.0, "the stop")
    until(lambda: page.inner_text("#verdict-word") == "Stopped", what="the word")
    page.wait_for_timeout(1500)
    assert not {"Not done", "No answer"} & set(page.evaluate("words"))
    link.down.rate = math.inf
    until(lambda: page.evaluate("overreach.fitness.good"), what="a link that is good again")
    arm(page, observer)
    press(page)
    until(lambda: observer.speed() > 0.2, what="motion")
    page.mouse.up()


def test_a_link_that_stalls(thin: tuple[Page, Narrow], cockpit: Cockpit) -> None:
    """A page that is not heard any more says so, lets go, and does not go on by itself when it is heard again."""
    (page, link), observer = thin, cockpit.observer
    arm(page, observer)
    press(page)
    until(lambda: observer.speed() > 0.2, what="motion")
    since = time.monotonic()
    link.up.rate = 1.0
    until(lambda: page.inner_text("#verdict-word") == "View only", what="the words")
    assert observer.stop_time(since) <= observer.welcome.stop_time + STEP_S
    assert not page.evaluate("overreach.stick.held")
    page.wait_for_timeout(600)
    link.up.rate = math.inf
    until(lambda: page.evaluate("overreach.link.ready && overreach.fitness.good"), what="a link that is good again")
    page.wait_for_timeout(500)
    assert observer.speed() == 0.0
    page.mouse.up()


def test_a_silent_robot_is_not_a_late_link(context: BrowserContext, fresh_cockpit: Cockpit) -> None:
    """A robot side that says nothing for 2 s is called silent, not late; then the page knows how old things are."""
    cockpit = fresh_cockpit
    page = cockpit.watch(context.new_page())
    page.evaluate(f"void (() => {{ {LISTEN} }})()")
    cockpit.robot.process.send_signal(signal.SIGSTOP)
    try:
        until(lambda: "silent" in page.inner_text("#verdict-reason"), what="the words")
        page.wait_for_timeout(1500)
    finally:
        cockpit.robot.process.send_signal(signal.SIGCONT)
    until(lambda: page.inner_text("#verdict-word") == "Disarmed", what="news of it")
    page.wait_for_timeout(700)
    assert "View only" not in page.evaluate("words")
    knows = page.evaluate("(performance.now() + overreach.link.delay.ahead) / 1000")
    assert knows == pytest.approx(time.monotonic(), abs=0.25)  # the robot's clock is this machine's
    page.evaluate("overreach.link.socket.send('{}')")
    until(lambda: "Not understood" in page.inner_text("#verdict-reason"), what="what nobody asked for")


def test_the_page_changes_its_mind_seldom(page: Page) -> None:
    """Lateness that comes and goes every second, for 10 minutes, makes the page change its mind 14 times at most."""
    changes = page.evaluate(
        """async () => {
            const { Fitness } = await import("/static/link/fitness.js");
            const counts = [];
            for (const beat of [200, 1000, 3000, 20000]) {
                const one = new Fitness();
                const start = performance.now();
                let [changes, was] = [0, true];
                for (let at = start; at < start + 600000; at += 100) {
                    const good = one.look(Math.floor((at - start) / beat) % 2 ? 600 : 20, at);
                    changes += good !== was;
                    was = good;
                }
                counts.push(changes);
            }
            const steady = new Fitness();
            const start = performance.now();
            let bad = 0;
            for (let at = start; at < start + 60000; at += 100) bad += !steady.look(480, at);
            return [...counts, bad];
        }"""
    )
    assert changes[-1] == 0
    assert max(changes[:-1]) <= 14, changes
