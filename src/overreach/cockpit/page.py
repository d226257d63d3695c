"""The page's layout. What moves on it is drawn by `static/`, from the WebSocket."""

from __future__ import annotations

from importlib.resources import files

from nicegui import ui

from overreach import __version__
from overreach.cockpit.relay import Relay
from overreach.cockpit.settings_panel import SettingsPanel
from overreach.link.messages import Settings

_KEY = '<span><i class="k-base"></i>{0}<sub>b</sub> base <i class="k-arm"></i>{0}<sub>m</sub> arm</span>'
PLOTS = {
    "l": "<b>l</b> m",
    "psi": "<b>ψ</b> rad",
    "linear": f"<b>linear</b> m/s {_KEY.format('v')}",
    "angular": f"<b>angular</b> rad/s {_KEY.format('ω')}",
}
"""The plots, top to bottom, with their captions; `static/plots.js` says what is in each."""
STATIC = files("overreach.cockpit").joinpath("static")


def build_page(relay: Relay) -> None:
    """Build one visitor's page."""
    ui.add_head_html(
        '<meta name="color-scheme" content="light dark">'
        f'<link rel="stylesheet" href="/static/style.css?v={__version__}">'
        f'<script type="module" src="/static/main.js?v={__version__}"></script>'
    )
    with ui.element("div").props("id=console"):
        _markup("stage").props("id=cockpit")
        with ui.element("aside").props('id=side aria-label="Plots and settings"'):
            ui.html(_AUTHORITY, sanitize=False, tag="div")
            with ui.element("section").classes("card"):
                ui.html("<h2>Last 20 s</h2>", sanitize=False)
                with ui.element("div").props("id=plots"):
                    for name, caption in PLOTS.items():
                        ui.html(caption, sanitize=False, tag="p").classes("caption")
                        ui.echart({}).classes("plot").props(
                            f'data-plot="{name}" role=img aria-label="{name} over time"'
                        )
            _markup("inputs")
            _settings(relay)


def _markup(name: str) -> ui.html:
    """Add the elements of one of our own files."""
    return ui.html(STATIC.joinpath(f"{name}.html").read_text("utf-8"), sanitize=False, tag="div")


def _settings(relay: Relay) -> None:
    """Add the settings; they are made anew when the robot side is another than before."""
    with ui.element("div") as place:
        panel = SettingsPanel(relay)

    def show(settings: Settings) -> None:
        nonlocal panel
        if panel.welcome is not relay.welcome and panel.differs(relay.welcome):
            place.clear()
            with place:
                panel = SettingsPanel(relay)
        panel.show(settings)

    relay.on_settings.add(show)
    ui.context.client.on_delete(lambda: relay.on_settings.discard(show))


_AUTHORITY = """
<section class="card" id="authority" aria-label="Who moves">
  <h2>Who moves the hand</h2>
  <div class="share" data-share="mu">
    <span class="what">linear</span><span class="sym">μ</span>
    <span class="bar" role="meter" aria-label="base's share of linear motion" aria-valuemin="0" aria-valuemax="1"
      aria-valuenow="0"><i></i></span>
    <b class="who" data-who="arm">arm</b><span class="value">0.00</span>
  </div>
  <div class="share" data-share="sigma">
    <span class="what">angular</span><span class="sym">σ</span>
    <span class="bar" role="meter" aria-label="base's share of angular motion" aria-valuemin="0" aria-valuemax="1"
      aria-valuenow="0"><i></i></span>
    <b class="who" data-who="arm">arm</b><span class="value">0.00</span>
  </div>
</section>
"""
