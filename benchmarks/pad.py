"""From a movement of the pointer on the pad to the drawn state that has taken it in."""

from __future__ import annotations

from collections.abc import Iterator

from benchmarks.measure import Promise, percentile
from overreach.link.endpoint import free_port
from tests.browser.chromium import chromium
from tests.processes import half

STEPS = 200

PROBE = """
() => {
  const { page, stick, view } = window.overreach;
  window.took = [];
  let waiting = null;
  document.getElementById("pad").addEventListener("pointerrawupdate", (event) => {
    if (!waiting) waiting = { seq: stick.seq + (stick.due ? 1 : 0), at: event.timeStamp }; // sent, or about to be
  });
  view.afterDraw.push(() => {
    if (waiting && page.drawn && page.drawn.ack >= waiting.seq) {
      window.took.push(performance.now() - waiting.at);
      waiting = null;
    }
  });
}
"""


def run() -> Iterator[Promise]:
    """Measure STEPS movements in Chromium."""
    with half("drive", "--no-browser", "--port", str(free_port())) as drive, chromium() as browser:
        page = browser.new_page(viewport={"width": 1360, "height": 850})
        page.goto(drive.url())
        page.wait_for_function("window.overreach?.page.state && overreach.link.ready")
        page.click("#arm")
        box = page.locator("#pad").bounding_box()
        assert box
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        page.mouse.move(x, y)
        page.mouse.down()
        page.evaluate(PROBE)
        for k in range(STEPS * 2):
            page.mouse.move(x + 40 * ((k % 7) - 3) / 3, y - 20 - 40 * (k % 5) / 5)
            page.wait_for_timeout(43 + k % 17)
            if page.evaluate("window.took.length") >= STEPS:
                break
        took = page.evaluate("window.took")
        page.mouse.up()
    name = f"pad to drawn state, {len(took)} steps"
    low, high = percentile(took, 0.25), percentile(took, 0.75)
    yield Promise(f"{name}: median", percentile(took, 0.5), low, high, "ms")
    yield Promise(f"{name}: p95", percentile(took, 0.95), low, high, "ms", 25.0)
