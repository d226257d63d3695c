"""What an operator may change: settings become a law and a model, built beside the loop, never on its thread."""

from __future__ import annotations

import contextlib
import gc
import os
from collections.abc import Callable
from concurrent.futures import Future
from threading import Thread
from typing import final

import msgspec

from overreach.errors import SetupError
from overreach.law.blend import Blend, Step
from overreach.law.body import Planner, WholeBody, check_fits
from overreach.law.laws import usual_blend
from overreach.link.messages import Choice, Plug, Scene, Settings, encode
from overreach.model.handed import HandedRobot, hand_of
from overreach.model.model import Model, check_workspace
from overreach.model.outline import bands, wheels, workspace
from overreach.parameters import Parameters, schema, summary
from overreach.plugs import BLENDS, blend_plug, blends_in, law_names, law_plug, load_blend, load_law, names, usable
from overreach.types import Frame, Record

DIGITS = 4


class Built(Record, frozen=True):
    """Settings, as a law, its planner and a robot's model that can be used, and as they look."""

    settings: Settings
    law: WholeBody
    model: Model
    planner: Planner
    scene: Scene


def usual(model: Model, law: Choice) -> Settings:
    """Return the settings that a robot starts with.

    Pages command in their picture's frame, the world's, unless the law has one of its own.
    """
    own = law_plug(law.name).frame
    frame = Frame.WORLD if own is Frame.HAND else own
    settings = Settings(model.workspace, law, frame=frame, hand=hand_of(model))
    if not model.workspace.edges:
        return settings
    blend = usual_blend(load_blend(settings.blend.name, settings.blend.parameters), model)
    widths = {one.name: round(getattr(blend, one.name), DIGITS) for one in schema(type(blend))}
    return msgspec.structs.replace(settings, blend=Choice(settings.blend.name, widths))


def build(settings: Settings, model: Model, hand: str = "") -> Built:
    """Return `settings` ready for use; raises SetupError if they cannot be used. May import, and be slow.

    hand: the one that is driven so far, by default that of `model`: another begins with its own whole workspace.
    The speed is left to the gate, which checks it when they come into force.
    """
    if isinstance(model, HandedRobot):
        driven, model = hand or model.hand, model.with_hand(settings.hand)
        if settings.hand != driven:
            own = usual(model, settings.law)  # the other hand's workspace is its own, and the bands in it
            settings = msgspec.structs.replace(settings, workspace=own.workspace, blend=own.blend)
    elif settings.hand != hand_of(model):
        raise SetupError(f"{model.name} has one hand: there is no {settings.hand!r}")
    placed_model = model.placed(model.mount, settings.workspace)
    check_workspace(placed_model, settings.workspace)
    blend = load_blend(settings.blend.name, settings.blend.parameters)
    law = load_law(settings.law.name, settings.law.parameters, blend)
    check_fits(law, model)
    drawn: Blend = getattr(law, "blend", Step())
    edges = bands(placed_model, drawn.width_l, drawn.width_psi)
    scene = Scene(model.base.footprint, wheels(model.base), workspace(placed_model), edges)
    encode(scene)  # what cannot be sent is told now
    settings = msgspec.structs.replace(settings, law=_read(settings.law, law), blend=_read(settings.blend, blend))
    return Built(settings, law, placed_model, law.planner(placed_model), scene)


def _read(chosen: Choice, plug: Parameters) -> Choice:
    """Return a choice with its numbers as numbers, where they were given as texts."""
    return Choice(chosen.name, {name: getattr(plug, name) for name in chosen.parameters})


def laws_to_choose(model: Model) -> dict[str, Plug]:
    """Return the laws and whole bodies that can be used on a robot, with their parameters."""
    return _to_choose(
        usable(law_names(model), law_plug), lambda plug: Plug(summary(plug), schema(plug), blends_in(plug))
    )


def blends_to_choose() -> dict[str, Plug]:
    """Return the blends that can be used, with their parameters."""
    return _to_choose(usable(names(BLENDS), blend_plug), lambda plug: Plug(summary(plug), schema(plug)))


def _to_choose(found: dict[str, type[Parameters] | str], made: Callable[[type[Parameters]], Plug]) -> dict[str, Plug]:
    """Return what can be described and sent of what was found."""
    plugs = {}
    for name, plug in found.items():
        if not isinstance(plug, str):
            with contextlib.suppress(Exception):
                described = made(plug)
                encode(described)
                plugs[name] = described
    return plugs


def _ordinary() -> None:
    """Give this thread an ordinary priority; it would inherit that of the loop, which starts it."""
    with contextlib.suppress(AttributeError, OSError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


@final
class Builder:
    """Builds settings on threads of their own, which nobody waits for at the end."""

    def begin(self, settings: Settings, model: Model, hand: str = "") -> Future[Built]:
        """Begin to build; the future holds the result, or the SetupError. hand: as in `build`."""
        future: Future[Built] = Future()
        Thread(target=self._build, args=(settings, model, hand, future), name="settings", daemon=True).start()
        return future

    @staticmethod
    def _build(settings: Settings, model: Model, hand: str, future: Future[Built]) -> None:
        _ordinary()
        try:
            built = build(settings, model, hand)
        except BaseException as error:  # a law that is a plug-in may raise anything: it is told where it is taken
            future.set_exception(error)
            return
        gc.freeze()  # freeze what an import allocated, so that the collector does not scan it while driving
        future.set_result(built)
