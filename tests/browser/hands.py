"""Fingers, mouse buttons and keys by the browser's own input pipeline."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from playwright.sync_api import CDPSession, Page

from tests.browser.conftest import Cockpit
from tests.processes import Observer, until

SHIFT = 8
Point = tuple[float, float]


def middle(page: Page, what: str) -> Point:
    """Return the middle of an element."""
    box = page.locator(what).first.bounding_box()
    assert box
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


class Fingers:
    """Any number of fingers, each by its own number, and keys with whatever they say of themselves."""

    def __init__(self, page: Page) -> None:
        self._session: CDPSession = page.context.new_cdp_session(page)
        self._down: dict[int, Point] = {}

    def _tell(self, kind: str) -> None:
        points = [{"x": x, "y": y, "id": finger} for finger, (x, y) in self._down.items()]
        self._session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def press(self, finger: int, at: Point) -> None:
        """Put a finger down."""
        self._down[finger] = at
        self._tell("touchStart")

    def slide(self, finger: int, to: Point, steps: int = 5) -> None:
        """Move a finger."""
        (x, y) = self._down[finger]
        for k in range(1, steps + 1):
            self._down[finger] = (x + (to[0] - x) * k / steps, y + (to[1] - y) * k / steps)
            self._tell("touchMove")

    def lift(self, *fingers: int) -> None:
        """Take fingers away, all where none is named."""
        for finger in fingers or tuple(self._down):
            x, y = self._down.pop(finger)
            end = {"type": "touchEnd", "touchPoints": [{"x": x, "y": y, "id": finger}]}  # an end lists what ends
            self._session.send("Input.dispatchTouchEvent", end)

    def scale(self, factor: float) -> None:
        """Zoom the page, as two fingers do."""
        self._session.send("Emulation.setPageScaleFactor", {"pageScaleFactor": factor})

    def key(self, kind: str, key: str, code: str = "", modifiers: int = 0) -> None:
        """Send keyDown or keyUp exactly so."""
        self._session.send("Input.dispatchKeyEvent", {"type": kind, "key": key, "code": code, "modifiers": modifiers})


def arm(page: Page, observer: Observer) -> None:
    """Arm from the page; before that lift whatever stop is there."""
    if observer.now.stopped:
        until(lambda: observer.speed() == 0.0, what="rest")
        until(lambda: page.is_enabled("#reset"), what="Reset")
        page.evaluate("overreach.buttons.reset()")
        until(lambda: not observer.now.stopped, what="the reset")
    if not observer.now.armed:
        page.evaluate("overreach.buttons.arm()")
    until(lambda: observer.now.armed, what="armed")
    until(lambda: page.get_attribute("#pad", "data-armed") == "true", what="the page's news of it")


@contextmanager
def stopping(page: Page, cockpit: Cockpit, what: str) -> Iterator[None]:
    """Armed before, and stopped by what happens inside, before anything is let go of."""
    arm(page, cockpit.observer)
    yield
    until(lambda: cockpit.observer.now.stopped, 5.0, what)


def top_most(page: Page, what: str) -> bool:
    """Say whether nothing lies over the middle of an element, and that it is in view."""
    found: Any = page.evaluate(
        """(what) => {
            const element = document.querySelector(what);
            const box = element.getBoundingClientRect();
            const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
            const inside =
                box.top >= 0 && box.left >= 0 && box.bottom <= innerHeight + 0.5 && box.right <= innerWidth + 0.5;
            return inside && element.contains(document.elementFromPoint(x, y));
        }""",
        what,
    )
    return bool(found)
