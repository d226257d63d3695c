"""What the page shows when the guard has spoken, and at the end."""

from __future__ import annotations

import signal
from pathlib import Path

import msgspec
import pytest
from playwright.sync_api import BrowserContext

from overreach.link.messages import Accepted, Choice, ConfigureRequest
from overreach.verdicts import Verdict
from tests.browser.conftest import Cockpit, running_cockpit
from tests.browser.test_drive import arm
from tests.plugin import install
from tests.processes import until

pytestmark = [pytest.mark.browser, pytest.mark.real_time]
LOOKS = {"stop", "down", "warn", "ready", "go"}


def test_a_fault_on_the_page(context: BrowserContext, tmp_path: Path) -> None:
    """A law that goes bad while a person drives: Fault and its reason; Reset, a law that is right, Arm, a new press."""
    with running_cockpit(install(tmp_path)) as cockpit:
        observer = cockpit.observer
        bad, good = (msgspec.structs.replace(observer.welcome.settings, law=Choice(law)) for law in ("nan", "exact"))
        assert observer.link.request(ConfigureRequest(bad)) == Accepted()
        page = cockpit.watch(context.new_page())
        arm(page, observer)
        page.keyboard.down("ArrowUp")
        until(lambda: page.inner_text("#verdict-word") == "Fault", what="the fault")
        assert page.inner_text("#verdict-reason") == "The law 'nan' answered v_b = nan. Press Reset, then Arm."
        assert page.get_attribute("#verdict", "data-kind") == "stop"
        until(lambda: observer.speed() == 0.0, what="standstill")
        assert page.is_disabled("#arm")
        assert page.is_enabled("#reset")
        assert "Press Reset" in page.inner_text("#pad-hint")
        assert observer.link.request(ConfigureRequest(good)) == Accepted()
        page.click("#reset")
        until(lambda: page.inner_text("#verdict-word") == "Disarmed", what="the reset")
        arm(page, observer)
        page.wait_for_timeout(300)
        assert observer.speed() == 0.0  # the key is still down: that press no longer counts
        page.keyboard.up("ArrowUp")
        page.keyboard.down("ArrowUp")
        until(lambda: observer.speed() > 0.3, what="motion after a new press")
        page.keyboard.up("ArrowUp")
        assert cockpit.errors == []


@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGHUP])
def test_the_page_tells_of_the_end(context: BrowserContext, fresh_cockpit: Cockpit, how: signal.Signals) -> None:
    """A robot side that is told to end says so on the page, while it ramps and afterwards."""
    page = fresh_cockpit.watch(context.new_page())
    arm(page, fresh_cockpit.observer)
    page.keyboard.down("ArrowUp")
    until(lambda: fresh_cockpit.observer.speed() > 0.39, what="full speed")
    page.evaluate(
        "window.words = new Set(); const word = document.getElementById('verdict-word');"
        "new MutationObserver(() => words.add(word.textContent))"
        ".observe(word, {childList: true, characterData: true, subtree: true})"
    )
    assert fresh_cockpit.robot.end(how) == 0
    until(lambda: page.inner_text("#verdict-reason") == "The robot side has ended.", what="the end")
    assert "Ending" in page.evaluate("[...words]")
    assert page.inner_text("#verdict-word") == "No connection"
    assert page.evaluate("overreach.page.state.base.v_x") == 0


def test_every_verdict_has_a_look() -> None:
    """Each verdict has a word, a sentence and a look that the page knows, in one table, weightiest first."""
    style = (Path("src/overreach/cockpit/static/style.css")).read_text()
    for k, verdict in enumerate(Verdict):
        assert verdict.severity == k
        assert verdict.look in LOOKS
        assert verdict.word
        assert verdict.sentence.endswith(".")
        assert verdict.look == "down" or f'.verdict[data-kind="{verdict.look}"]' in style
