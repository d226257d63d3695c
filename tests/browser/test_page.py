"""What the page shows, and that it shows it everywhere."""

from __future__ import annotations

import contextlib
import http.client
import re
from typing import Literal

import msgspec
import pytest
from playwright.sync_api import BrowserContext, Error, Page

from tests.browser.conftest import Cockpit
from tests.browser.test_drive import arm
from tests.browser.upgrade import upgrade
from tests.processes import until

pytestmark = [pytest.mark.browser, pytest.mark.real_time]


def test_no_external_request(fresh_page: Page, cockpit: Cockpit) -> None:
    """The page asks nobody but its own server for anything, and nothing goes wrong in it."""
    fresh_page.wait_for_timeout(1000)
    foreign = [url for url in cockpit.requests if not url.startswith((cockpit.url, "data:", "blob:"))]
    assert foreign == []
    assert len(cockpit.requests) > 10
    assert cockpit.errors == []


def choose_law(page: Page, name: str) -> None:
    """Choose a law in the list. On a busy machine the list may close again before it is clicked: open it again."""
    option = page.locator(f'.q-menu .q-item:has-text("{name}")')

    def chosen() -> bool:
        if not option.is_visible():
            page.click("#set-law")
        with contextlib.suppress(Error):
            option.click(timeout=2_000)
            return True
        return False

    until(chosen, what=f"the choice of {name}")
    page.locator(".q-menu").wait_for(state="detached")  # it takes the focus with it when it goes


def test_settings_are_live(page: Page, cockpit: Cockpit) -> None:
    """Law, blend, frame, widths, workspace and speed are changed on the page and come into force on the robot."""
    observer = cockpit.observer

    def slide(field: str, keys: list[str]) -> None:
        slider = page.locator(f'#set-{field} [tabindex="0"]').first
        slider.wait_for(state="visible")
        text = page.locator(f"#settings .line:has(+ #set-{field}) .value")
        for key in keys:
            before = text.inner_text()
            slider.focus()
            page.keyboard.press(key)
            until(lambda before=before: text.inner_text() != before, what=f"{field} to answer a key")  # type: ignore[misc]  # bound in a loop

    def force() -> dict[str, object]:
        settings = observer.link.welcome(5.0).settings
        flat = {"law": settings.law.name, "blend": settings.blend.name, "frame": settings.frame.value}
        numbers = {**settings.blend.parameters, **settings.law.parameters, "speed_scale": settings.speed_scale}
        return {**flat, **numbers, **msgspec.structs.asdict(settings.workspace)}

    choose_law(page, "paper")
    until(lambda: force()["law"] == "paper", what="the law")
    page.click('#set-frame button:has-text("world")')
    until(lambda: force()["frame"] == "world", what="the frame")
    until(lambda: page.inner_text("#unit-w") == "m/s", what="the unit of the pad")
    page.click('#set-blend button:has-text("tanh")')
    until(lambda: force()["blend"] == "tanh", what="the blend")
    slide("alpha", ["ArrowRight"] * 3)
    until(lambda: force().get("alpha") == 53.0, what="alpha")
    slide("beta", ["ArrowLeft"] * 2)
    until(lambda: force().get("beta") == 48.0, what="beta")
    slide("speed_scale", ["ArrowLeft"] * 4)
    until(lambda: force()["speed_scale"] == pytest.approx(0.8), what="the speed")
    slide("l_min", ["ArrowRight"] * 2)
    until(lambda: force()["l_min"] == pytest.approx(0.47), what="L_min")
    slide("psi_min", ["ArrowRight"] * 2)
    until(lambda: force()["psi_min"] == pytest.approx(-0.5), what="Psi_min")
    until(lambda: page.evaluate("overreach.page.settings.workspace.psi_min") == pytest.approx(-0.5), what="the view")
    page.click("#defaults")
    until(lambda: force()["law"] == "exact", what="the defaults")
    until(lambda: "exact" in page.locator("#settings").inner_text(), what="the controls")
    assert cockpit.errors == []


def test_a_laws_own_parameters_are_on_the_page(page: Page, cockpit: Cockpit) -> None:
    """What a law's description says is offered: the weight of `weighted`, solver and damping of `qp`; and is used."""
    observer = cockpit.observer
    choose_law(page, "weighted")
    slider = page.locator('#set-base_weight [tabindex="0"]').first
    slider.wait_for(state="visible")
    slider.focus()
    page.keyboard.press("ArrowRight")
    until(lambda: observer.link.welcome(5.0).settings.law.parameters.get("base_weight") == pytest.approx(1.1))
    assert page.locator("#set-damping").first.is_hidden()
    choose_law(page, "qp")
    page.locator("#set-damping").first.wait_for(state="visible")
    page.locator("label:has(#set-solver) >> visible=true").first.click()
    page.locator(".q-menu .q-item", has_text="quadprog").click()
    until(lambda: observer.link.welcome(5.0).settings.law.parameters.get("solver") == "quadprog", what="the solver")
    assert cockpit.errors == []


def test_settings_reach_other_pages(page: Page, context: BrowserContext, cockpit: Cockpit) -> None:
    """Settings that one page changes are shown by the other."""
    other = cockpit.watch(context.new_page())
    choose_law(page, "switch")
    until(lambda: other.evaluate("overreach.page.settings.law.name") == "switch", what="the other page")
    until(lambda: "switch" in other.locator("#settings").inner_text(), what="the other page's controls")


def test_plots_are_drawn(page: Page, cockpit: Cockpit) -> None:
    """The plots hold what the robot told, with the limits in force."""
    arm(page, cockpit.observer)
    page.keyboard.down("ArrowUp")
    page.wait_for_timeout(1500)
    page.keyboard.up("ArrowUp")
    chart = page.evaluate(
        """async () => {
            const { echarts } = await import("nicegui-echart");
            const series = [...document.querySelectorAll(".plot")]
                .flatMap((plot) => echarts.getInstanceByDom(plot).getOption().series);
            return Object.fromEntries(series.map((s) => [s.name, s.data]));
        }"""
    )
    for name in ("l", "psi", "v_b", "v_m", "w_b", "w_m"):
        assert len(chart[name]) > 5, name
    assert chart["l"][-1][1] > 0.66
    for limit, value in (("l_min", 0.45), ("l_max", 0.85), ("psi_min", -0.6), ("psi_max", 0.6)):
        assert [point[1] for point in chart[limit]] == [value, value]


def test_view_follows_zooms_and_pans(page: Page, cockpit: Cockpit) -> None:
    """The camera follows the robot until it is dragged; the wheel and the buttons zoom."""
    scale = page.evaluate("overreach.view.scale")
    page.click("#zoom-in")
    assert page.evaluate("overreach.view.scale") == pytest.approx(scale * 1.25)
    page.mouse.move(300, 400)
    page.mouse.wheel(0, 200)
    until(lambda: page.evaluate("overreach.view.scale") < scale * 1.25, what="the wheel")
    page.mouse.down()
    page.mouse.move(360, 430, steps=3)
    page.mouse.up()
    assert page.get_attribute("#follow", "aria-pressed") == "false"
    page.click("#follow")
    assert page.get_attribute("#follow", "aria-pressed") == "true"
    page.wait_for_timeout(1500)  # the camera comes back to the robot
    at_first = page.evaluate("overreach.view.centre.x")
    arm(page, cockpit.observer)
    page.keyboard.down("ArrowUp")
    until(lambda: cockpit.observer.now.pose.x > 0.5, what="a drive")
    page.keyboard.up("ArrowUp")
    until(lambda: page.evaluate("overreach.view.centre.x") > at_first + 0.3, what="the camera")
    trails = page.evaluate("[overreach.view.trails.hand.length, overreach.view.trails.base.length]")
    assert min(trails) > 10
    page.click("#restart")
    until(lambda: abs(cockpit.observer.now.pose.x) < 1e-9, what="the start")


SCHEMES: tuple[Literal["light", "dark"], ...] = ("light", "dark")
SIZES = [(1360, 850), (1920, 1080), (1024, 700), (820, 1180), (390, 844), (360, 640)]


def test_layout(page: Page) -> None:
    """From phone to desktop, light and dark: nothing overflows sideways, and what drives is on the first screen."""
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        for scheme in SCHEMES:
            page.emulate_media(color_scheme=scheme)
            until(lambda scheme=scheme: page.get_attribute("html", "data-theme") == scheme)  # type: ignore[misc]  # bound in a loop
            page.wait_for_timeout(50)
            assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), width
            for one in ("#arm", "#reset", "#stop", "#pad", "#view", "#verdict", "#authority"):
                box = page.locator(one).bounding_box()
                assert box, one
                assert box["x"] >= 0, (one, width)
                assert box["x"] + box["width"] <= width + 0.5, (one, width)
                assert box["y"] >= 0, (one, width)
                assert box["y"] + box["height"] <= height + 0.5, (one, width)
            background = page.evaluate("getComputedStyle(document.body).backgroundColor")
            light = sum(int(part) for part in re.findall(r"\d+", background)[:3]) > 384
            assert light == (scheme == "light")


def test_texts_have_contrast(page: Page) -> None:
    """In light and dark, text colours have a contrast of at least 4.5 on the surfaces they stand on (WCAG AA)."""

    def luminance(colour: str) -> float:
        parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
        linear = [part / 12.92 if part <= 0.03928 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    style = "getComputedStyle(document.documentElement).getPropertyValue('--{}').trim()"
    for scheme in SCHEMES:
        page.emulate_media(color_scheme=scheme)
        until(lambda scheme=scheme: page.get_attribute("html", "data-theme") == scheme)  # type: ignore[misc]  # bound in a loop
        for surface in ("panel", "bg"):
            behind = luminance(page.evaluate(style.format(surface)))
            for name in ("ink", "muted", "arm", "base", "ok", "warn", "hand"):
                front = luminance(page.evaluate(style.format(name)))
                ratio = (max(front, behind) + 0.05) / (min(front, behind) + 0.05)
                assert ratio >= 4.5 or (surface == "bg" and ratio >= 4.0), (scheme, name, surface, ratio)


def test_theme_button(page: Page) -> None:
    """The button changes between light and dark, and a reload keeps the choice."""
    first = page.get_attribute("html", "data-theme")
    page.click("#theme")
    second = page.get_attribute("html", "data-theme")
    assert {first, second} == {"light", "dark"}
    page.reload()
    page.wait_for_function("window.overreach?.page.state")
    assert page.get_attribute("html", "data-theme") == second


def test_page_says_when_the_robot_side_is_gone(context: BrowserContext, fresh_cockpit: Cockpit) -> None:
    """A robot side that has ended is told on the page within seconds."""
    cockpit = fresh_cockpit
    page = cockpit.watch(context.new_page())
    cockpit.robot.process.kill()
    until(lambda: "silent" in page.inner_text("#verdict-reason"), what="the news")


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "http://evil.example"},
        {"Origin": "http://evil.example", "Host": "evil.example"},
        {},
        {"Origin": "null"},
    ],
)
def test_foreign_origins_do_not_get_in(shared_cockpit: Cockpit, headers: dict[str, str]) -> None:
    """The WebSocket is refused with 403 to any page that this cockpit did not serve."""
    assert upgrade(shared_cockpit.url, headers) == 403


def test_the_own_origin_gets_in(shared_cockpit: Cockpit) -> None:
    """The same request with the page's own origin is let in: the refusals above are about the origin."""
    assert upgrade(shared_cockpit.url, {"Origin": shared_cockpit.url}) == 101


def test_foreign_hosts_get_nothing(shared_cockpit: Cockpit) -> None:
    """No page, file or socket is served under a name that a foreign site may have pointed here."""
    for path in ("/", "/static/main.js", "/_nicegui_ws/socket.io/"):
        connection = http.client.HTTPConnection(shared_cockpit.url.removeprefix("http://"), timeout=10)
        connection.request("GET", path, headers={"Host": "evil.example"})
        assert connection.getresponse().status == 403, path
        connection.close()
    assert (
        upgrade(shared_cockpit.url, {"Origin": "http://evil.example"}, "/_nicegui_ws/socket.io/?transport=websocket")
        == 403
    )


@pytest.mark.parametrize("host", ["rover.local", "ROVER.local.", "rover", "localhost", "127.0.0.1", "[::1]"])
def test_names_that_are_allowed(shared_cockpit: Cockpit, host: str) -> None:
    """Under the names that it was told are its own, in any spelling, the page and its WebSocket are served."""
    port = shared_cockpit.url.rpartition(":")[2]
    connection = http.client.HTTPConnection(shared_cockpit.url.removeprefix("http://"), timeout=10)
    connection.request("GET", "/static/main.js", headers={"Host": f"{host}:{port}"})
    assert connection.getresponse().status == 200
    connection.close()
    assert upgrade(shared_cockpit.url, {"Origin": f"http://{host}:{port}", "Host": f"{host}:{port}"}) == 101


@pytest.mark.parametrize(
    ("host", "option"),
    [
        ("rover2.local:8420", "--allow-host rover2.local"),
        ("rover.local.evil.example", "--allow-host rover.local.evil.example"),
        ("<script>alert(1)</script>", "--allow-host NAME"),
        ("", "--allow-host NAME"),
    ],
)
def test_a_foreign_name_is_told_the_option(shared_cockpit: Cockpit, host: str, option: str) -> None:
    """The page of the refusal says which option to use, and runs nothing of what it was asked for as."""
    connection = http.client.HTTPConnection(shared_cockpit.url.removeprefix("http://"), timeout=10)
    connection.putrequest("GET", "/", skip_host=True)
    connection.putheader("Host", host)
    connection.endheaders()
    answer = connection.getresponse()
    text = answer.read().decode()
    connection.close()
    assert answer.status == 403
    assert option in text
    assert "<script" not in text
