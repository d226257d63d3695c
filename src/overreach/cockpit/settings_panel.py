"""The settings: NiceGUI's controls, one record behind them, the robot side as the judge."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, final

import msgspec
from nicegui import ui

from overreach.cockpit.relay import Relay
from overreach.errors import OverreachError
from overreach.link.messages import Accepted, Refused, Settings
from overreach.plugs import BLENDS, blends_in, law_names, law_plug, names
from overreach.types import Frame

THROTTLE_S = 0.1
"""A slider that is dragged asks for new settings at most this often."""


@final
class SettingsPanel:
    """One visitor's controls. What the robot side refuses is told and taken back."""

    def __init__(self, relay: Relay) -> None:
        self._relay = relay
        self._shown = relay.settings
        self._quiet = False
        self._asking = False
        self._wanted: dict[str, Any] = {}
        with ui.element("section").classes("card").props('id=settings aria-label="Settings"'):
            ui.html("<h2>Settings</h2>", sanitize=False)
            self._law = self._select("law", "Law", self._laws(self._shown.law))
            self._frame = self._toggle("frame", "Command frame", [frame.value for frame in Frame])
            self._blend = self._toggle(
                "blend",
                "Blend",
                names(BLENDS),
            )
            self._speed = self._slider("speed_scale", "Speed", 0.05, 1.0, 0.05, "×")
            self._tanh = ui.element("div").classes("group")
            with self._tanh:
                self._alpha = self._slider("alpha", "α  sharpness in l", 5.0, 200.0, 1.0, "1/m")
                self._beta = self._slider("beta", "β  sharpness in ψ", 5.0, 200.0, 1.0, "1/rad")
            self._smooth = ui.element("div").classes("group")
            with self._smooth:
                self._q_l = self._slider("q_l", "Q  width in l", 0.01, 0.3, 0.01, "m")
                self._q_psi = self._slider("q_psi", "Q  width in ψ", 0.01, 0.6, 0.01, "rad")
            reach = sum(relay.welcome.links)
            least = abs(relay.welcome.links[0] - relay.welcome.links[1]) + 0.05
            self._length = self._range("l_min", "l_max", "L  workspace in l", least, reach - 0.05, 0.01, "m")
            self._bearing = self._range("psi_min", "psi_max", "Ψ  workspace in ψ", -1.5, 1.5, 0.05, "rad")
            ui.button("Defaults", on_click=self._defaults).props('flat dense no-caps id="defaults"')
        self.show(relay.settings)

    @staticmethod
    def _laws(in_force: str) -> list[str]:
        """Return the laws to choose from: those installed here, and the one in force, which only the robot may have."""
        return sorted({*law_names(), in_force})

    def _select(self, field: str, label: str, options: list[str]) -> ui.select:
        return ui.select(options, label=label, value=getattr(self._shown, field), on_change=self._handler(field)).props(
            f'outlined dense options-dense id="set-{field}"'
        )

    def _toggle(self, field: str, label: str, options: list[str]) -> ui.toggle:
        ui.label(label).classes("line")
        return ui.toggle(options, value=getattr(self._shown, field), on_change=self._handler(field)).props(
            f'unelevated no-caps spread id="set-{field}" aria-label="{label}"'
        )

    def _line(self, label: str, unit: str) -> ui.label:
        with ui.element("div").classes("line"):
            ui.label(label)
            value = ui.label().classes("value")
            ui.label(unit).classes("unit")
        return value

    def _slider(self, field: str, label: str, least: float, most: float, step: float, unit: str) -> ui.slider:
        value = self._line(label, unit)
        slider = ui.slider(min=least, max=most, step=step, value=getattr(self._shown, field))
        slider.props(f'id="set-{field}" aria-label="{label}"')
        value.bind_text_from(slider, "value", backward=lambda number: f"{number:g}")
        slider.on("update:model-value", lambda: self._ask({field: slider.value}), throttle=THROTTLE_S)
        return slider

    def _range(self, low: str, high: str, label: str, least: float, most: float, step: float, unit: str) -> ui.range:
        value = self._line(label, unit)
        both = ui.range(
            min=least,
            max=most,
            step=step,
            value={"min": getattr(self._shown, low), "max": getattr(self._shown, high)},
        )
        both.props(f'id="set-{low}" aria-label="{label}"')
        value.bind_text_from(both, "value", backward=lambda pair: f"{pair['min']:g} to {pair['max']:g}")
        both.on(
            "update:model-value",
            lambda: self._ask({low: both.value["min"], high: both.value["max"]}),
            throttle=THROTTLE_S,
        )
        return both

    def _handler(self, field: str) -> Callable[[Any], Any]:
        async def changed(event: Any) -> None:
            if not self._quiet:
                await self._ask({field: Frame(event.value) if field == "frame" else event.value})

        return changed

    async def _ask(self, changes: dict[str, Any]) -> None:
        """Ask for the settings in force with `changes`. One question at a time; what comes meanwhile is added up."""
        self._wanted |= changes
        if self._asking:
            return
        self._asking = True
        try:
            while self._wanted:
                wanted = msgspec.structs.replace(self._relay.settings, **self._wanted)
                self._wanted = {}
                if wanted != self._relay.settings:
                    self._tell(await self._relay.configure(wanted))
        finally:
            self._asking = False
        self.show(self._relay.settings)

    def _tell(self, answer: Accepted | Refused) -> None:
        if isinstance(answer, Refused):
            ui.notify(answer.reason, type="warning", position="top")

    async def _defaults(self) -> None:
        self._tell(await self._relay.configure(self._relay.welcome.defaults))
        self.show(self._relay.settings)

    def show(self, settings: Settings) -> None:
        """Show `settings`, which are in force; not while this visitor's own hand is on a control."""
        if self._asking:
            return
        self._quiet = True
        self._shown = settings
        self._law.set_options(self._laws(settings.law), value=settings.law)
        self._frame.value = settings.frame
        self._blend.value = settings.blend
        for slider, value in (
            (self._speed, settings.speed_scale),
            (self._alpha, settings.alpha),
            (self._beta, settings.beta),
            (self._q_l, settings.q_l),
            (self._q_psi, settings.q_psi),
        ):
            slider.value = value
        self._length.value = {"min": settings.l_min, "max": settings.l_max}
        self._bearing.value = {"min": settings.psi_min, "max": settings.psi_max}
        try:
            blending = blends_in(law_plug(settings.law))
        except (OverreachError, ImportError):  # a law that only the robot's side has
            blending = True
        self._tanh.visible = settings.blend == "tanh" and blending
        self._smooth.visible = settings.blend == "smoothstep" and blending
        self._blend.set_enabled(blending)
        self._quiet = False
