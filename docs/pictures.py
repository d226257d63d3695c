"""Make the pictures of the page and of a workspace, as they are: `make pictures`."""

from __future__ import annotations

from pathlib import Path

from overreach.link.endpoint import free_port
from overreach.model.measure.command import run_workspace
from tests.browser.chromium import chromium
from tests.processes import half

HERE = Path(__file__).parent / "img"
WAY = ((0, -76, 3.4), (-46, -60, 2.4), (42, -64, 3.2))
"""Where the pad is held, in px from its centre, and for how long [s]."""


def main() -> None:
    """Drive a little and take the picture; measure and draw."""
    HERE.mkdir(exist_ok=True)
    with half("drive", "--no-browser", "--port", str(free_port())) as drive, chromium() as browser:
        page = browser.new_page(viewport={"width": 1360, "height": 800}, color_scheme="light")
        page.goto(drive.url())
        page.wait_for_function("window.overreach?.page.state")
        page.click("#arm")
        box = page.locator("#pad").bounding_box()
        assert box
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        page.mouse.move(x, y)
        page.mouse.down()
        for dx, dy, seconds in WAY:
            page.mouse.move(x + dx, y + dy, steps=8)
            page.wait_for_timeout(seconds * 1_000)
        page.screenshot(path=HERE / "cockpit.png")
    run_workspace("mobile7", "follow", find_home=False, out=None, figure=HERE / "workspace.png")


if __name__ == "__main__":
    main()
