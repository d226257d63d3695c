"""Choosing the hand that is driven, on the page."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from overreach.link.endpoint import free_port
from overreach.model.measure.command import run_workspace
from tests.browser.conftest import Cockpit
from tests.browser.hands import arm
from tests.pair import written
from tests.processes import half, robot, until

pytestmark = [pytest.mark.browser, pytest.mark.real_time]


def test_one_of_two_hands(browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A robot with two shows them; the other is refused in motion, with the reason, and driven from rest."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    path = written(tmp_path)
    for hand in ("left", "right"):
        run_workspace(f"{path}@{hand}", "", find_home=False, out=Path(path), figure=None)
    with robot(path) as (endpoint, side, observer):
        with half("cockpit", "--connect", endpoint, "--no-browser", "--port", str(free_port())) as running:
            cockpit = Cockpit(running.url(), running, side, observer, [], [])
            page = cockpit.watch(browser.new_context(viewport={"width": 1200, "height": 800}).new_page())
            arm(page, observer)
            right = page.locator("#set-hand").get_by_text("right")
            expect(page.locator("#set-hand")).to_contain_text("left")
            page.keyboard.down("w")
            until(lambda: observer.speed() > 0.1, what="motion")
            right.click()
            expect(page.get_by_text("another hand is driven only from rest")).to_be_visible()
            page.keyboard.up("w")
            # the four rates are the reach's: the wrist, which holds the hand's attitude, rests a little later
            until(
                lambda: observer.speed() == 0.0 and len({one.joints for one in list(observer.states)[-10:]}) == 1,
                what="rest",
            )
            assert observer.now.hand[1] > 0.0
            begin = observer.now.joints
            right.click()
            until(lambda: observer.now.hand[1] < 0.0, what="the right hand")
            page.locator("#stage").first.click(position={"x": 5, "y": 5})
            page.keyboard.down("w")
            until(lambda: observer.speed() > 0.1, what="motion")
            page.keyboard.up("w")
            until(lambda: observer.speed() == 0.0, what="rest")
            assert observer.now.joints[:6] == begin[:6]
            assert observer.now.joints[6:] != begin[6:]
            assert cockpit.errors == []
            page.screenshot(path=str(tmp_path / "hands.png"))
