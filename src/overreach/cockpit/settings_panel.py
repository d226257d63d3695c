"""The settings: NiceGUI controls made from the plugs' own descriptions; the robot side judges every change."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import reduce
from typing import Any, final

import msgspec
from nicegui import ui

from overreach.cockpit.relay import Relay
from overreach.link.messages import Accepted, Choice, Plug, Refused, Settings, Welcome
from overreach.parameters import Parameter
from overreach.types import Frame

PAUSE_S = 0.1
"""A slider that is dragged asks for new settings at most this often [s]."""
EDGE_M = 0.05
"""The workspace's range ends this far [m] short of the ends of the arm's reach."""
NONE = Plug("", ())

Change = Callable[[Settings], Settings]


@final
class SettingsPanel:
    """One visitor's controls. What the robot side refuses is shown and undone."""

    def __init__(self, relay: Relay) -> None:
        self._relay = relay
        self._quiet = False
        self._asking = False
        self._wanted: list[Change] = []
        welcome, shown = relay.welcome, relay.settings
        self.welcome = welcome
        """The robot side that the controls are made for."""
        self._own: dict[tuple[str, str], dict[str, Any]] = {}
        """The controls of each law's and each blend's own parameters."""
        self._groups: dict[tuple[str, str], ui.element] = {}
        with ui.element("section").classes("card").props('id=settings aria-label="Settings"'):
            ui.html("<h2>Settings</h2>", sanitize=False)
            self._hand = self._toggle("hand", "Hand", list(welcome.hands)) if welcome.hands else None
            self._law = self._select("law", "Law", self._laws(shown))
            self._parameters("law", welcome.laws)
            self._frame = self._toggle("frame", "Command frame", list(welcome.axes))
            self._blend = self._toggle("blend", "Blend", list(welcome.blends))
            self._parameters("blend", welcome.blends)
            self._speed = self._slider(
                "speed_scale", "Speed", 0.05, 1.0, 0.05, "×", shown.speed_scale, self._speed_changed
            )
            least, most = welcome.reach
            lengths, bearings = (least + EDGE_M, most - EDGE_M), (-1.5, 1.5)
            if (own := welcome.defaults.workspace).edges:  # as it was measured: it can only be made smaller
                lengths, bearings = (own.l_min, own.l_max), (own.psi_min, own.psi_max)
            self._length = self._range("l_min", "l_max", "L  workspace in l", *lengths, 0.01, "m")
            self._bearing = self._range("psi_min", "psi_max", "Ψ  workspace in ψ", *bearings, 0.05, "rad")
            ui.button("Defaults", on_click=self._defaults).props('flat dense no-caps id="defaults"')
        self.show(relay.settings)

    def differs(self, welcome: Welcome) -> bool:
        """Say whether another robot side offers other things to choose from."""
        own = self.welcome
        return (own.laws, own.blends, own.reach, own.defaults, own.axes, own.hands) != (
            welcome.laws, welcome.blends, welcome.reach, welcome.defaults, welcome.axes, welcome.hands,
        )  # fmt: skip

    @staticmethod
    def _speed_changed(value: float) -> Change:
        return lambda settings: _with(settings, speed_scale=value)

    def _laws(self, settings: Settings) -> list[str]:
        """Return the laws to choose from: those that the robot side has."""
        return sorted({*self._relay.welcome.laws, settings.law.name})

    def _parameters(self, kind: str, plugs: dict[str, Plug]) -> None:
        """Make the controls of each plug's own parameters, in a group that is shown with it."""
        for name, plug in plugs.items():
            controls = self._own[kind, name] = {}
            if not plug.parameters:
                continue
            with ui.element("div").classes("group") as group:
                for one in plug.parameters:
                    controls[one.name] = self._parameter(kind, name, one)
            self._groups[kind, name] = group

    def _parameter(self, kind: str, plug: str, one: Parameter) -> Any:
        """Return the control of one parameter."""

        def changed(value: Any) -> Change:
            def change(settings: Settings) -> Settings:
                chosen: Choice = getattr(settings, kind)
                own = chosen.parameters if chosen.name == plug else {}
                other: Settings = _with(settings, **{kind: Choice(plug, {**own, one.name: value})})
                return other

            return change

        if one.choices:
            select = ui.select(list(one.choices), label=one.title, value=one.default)
            select.props(f'outlined dense options-dense id="set-{one.name}"')
            select.on_value_change(self._handler(changed))
            return select
        value = float(one.default)
        return self._slider(one.name, one.title, one.low, one.high, one.step, one.unit, value, changed)

    def _select(self, field: str, label: str, options: list[str]) -> ui.select:
        select = ui.select(options, label=label, value=self._relay.settings.law.name)
        select.on_value_change(
            self._handler(lambda value: lambda settings: _with(settings, law=self._choice("law", value)))
        )
        return select.props(f'outlined dense options-dense id="set-{field}"')

    def _toggle(self, field: str, label: str, options: list[str]) -> ui.toggle:
        ui.label(label).classes("line")
        value = getattr(self._relay.settings, field)
        toggle = ui.toggle(options, value=value if isinstance(value, str) else value.name)

        def changed(value: str) -> Change:
            made = {"blend": lambda name: self._choice(field, name), "frame": Frame}
            chosen: Any = made.get(field, str)(value)
            return lambda settings: _with(settings, **{field: chosen})

        toggle.on_value_change(self._handler(changed))
        return toggle.props(f'unelevated no-caps spread id="set-{field}" aria-label="{label}"')

    def _choice(self, kind: str, name: str) -> Choice:
        """Return the choice of a plug, with its parameters as its controls show them."""
        return Choice(name, {key: control.value for key, control in self._own.get((kind, name), {}).items()})

    def _line(self, label: str, unit: str) -> ui.label:
        with ui.element("div").classes("line"):
            ui.label(label)
            value = ui.label().classes("value")
            ui.label(unit).classes("unit")
        return value

    def _slider(
        self, field: str, label: str, least: float, most: float, step: float, unit: str, shown: float, changed: Any
    ) -> ui.slider:
        value = self._line(label, unit)
        slider = ui.slider(min=least, max=most, step=step, value=shown)
        slider.props(f'id="set-{field}" aria-label="{label}"')
        value.bind_text_from(slider, "value", backward=lambda number: f"{number:g}")
        slider.on_value_change(self._handler(changed))
        return slider

    def _range(self, low: str, high: str, label: str, least: float, most: float, step: float, unit: str) -> ui.range:
        value = self._line(label, unit)
        space = self._relay.settings.workspace
        both = ui.range(min=least, max=most, step=step, value={"min": getattr(space, low), "max": getattr(space, high)})
        both.props(f'id="set-{low}" aria-label="{label}"')
        value.bind_text_from(both, "value", backward=lambda pair: f"{pair['min']:g} to {pair['max']:g}")

        def changed(ends: dict[str, float]) -> Change:
            def change(settings: Settings) -> Settings:
                space = _with(settings.workspace, **{low: ends["min"], high: ends["max"]})
                wanted: Settings = _with(settings, workspace=space)
                return wanted

            return change

        both.on_value_change(self._handler(changed))
        return both

    def _handler(self, changed: Callable[[Any], Change]) -> Callable[[Any], Any]:
        # Not itself a coroutine: that would begin later, when it can no longer tell whether `show` made the change.
        return lambda event: None if self._quiet else self._ask(changed(event.value))

    async def _ask(self, change: Change) -> None:
        """Ask for the settings in force with `change`. One question at a time; changes made meanwhile are combined."""
        self._wanted.append(change)
        if self._asking:
            return
        self._asking = True
        try:
            while self._wanted:
                changes, self._wanted = self._wanted, []
                try:
                    answer = await self._relay.configure(_one_after_the_other(changes))
                except ValueError as error:  # not a valid workspace
                    answer = Refused(str(error))
                self._tell(answer)
                await asyncio.sleep(PAUSE_S)
        finally:
            self._asking = False
        self.show(self._relay.settings)

    def _tell(self, answer: Accepted | Refused) -> None:
        if isinstance(answer, Refused):
            ui.notify(answer.reason, type="warning", position="top")

    async def _defaults(self) -> None:
        self._tell(await self._relay.configure(lambda _: self._relay.welcome.defaults))
        self.show(self._relay.settings)

    def show(self, settings: Settings) -> None:
        """Show `settings`, which are in force, unless a change of this visitor's own is still being asked for."""
        if self._asking:
            return
        self._quiet = True
        welcome, space = self.welcome, settings.workspace
        self._law.set_options(self._laws(settings), value=settings.law.name)
        if self._hand is not None:
            self._hand.value = settings.hand
        self._frame.value = settings.frame
        self._blend.value = settings.blend.name
        self._speed.value = settings.speed_scale
        self._length.value = {"min": space.l_min, "max": space.l_max}
        self._bearing.value = {"min": space.psi_min, "max": space.psi_max}
        blends = welcome.laws.get(settings.law.name, NONE).blends
        self._blend.set_enabled(blends)
        for (kind, name), group in self._groups.items():
            chosen: Choice = getattr(settings, kind)
            group.visible = chosen.name == name and (kind == "law" or blends)
            if chosen.name != name:
                continue
            plugs = welcome.laws if kind == "law" else welcome.blends
            for one in plugs[name].parameters:
                self._own[kind, name][one.name].value = chosen.parameters.get(one.name, one.default)
        self._quiet = False


def _one_after_the_other(changes: list[Change]) -> Change:
    return lambda settings: reduce(lambda now, change: change(now), changes, settings)


_with: Any = msgspec.structs.replace
