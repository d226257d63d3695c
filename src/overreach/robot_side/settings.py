"""What an operator may change: the settings as a law and a model, made beside the loop, never on its thread."""

from __future__ import annotations

import contextlib
import gc
import os
from concurrent.futures import Future, ThreadPoolExecutor
from typing import final

from overreach.errors import SetupError
from overreach.law.body import WholeBody
from overreach.link.messages import Choice, Plug, Settings
from overreach.model.model import Model, check_workspace, placed
from overreach.parameters import schema, summary
from overreach.plugs import BLENDS, blend_plug, blends_in, law_names, law_plug, load_blend, load_law, names, usable
from overreach.types import Record


class Built(Record, frozen=True):
    """Settings, as a law and a robot's model that can be used."""

    settings: Settings
    law: WholeBody
    model: Model


def usual(model: Model, law: Choice) -> Settings:
    """Return the settings that a robot starts with."""
    return Settings(model.workspace, law, frame=law_plug(law.name).frame)


def build(settings: Settings, model: Model) -> Built:
    """Return `settings` ready for use; raises SetupError where they cannot be used. May import, and take its time."""
    if not 0.0 < settings.speed_scale <= 1.0:
        raise SetupError(f"speed scale must be > 0 and <= 1, got {settings.speed_scale:g}")
    placed_model = placed(model, model.mount, settings.workspace)
    check_workspace(placed_model, settings.workspace)
    blend = load_blend(settings.blend.name, settings.blend.parameters)
    law = load_law(settings.law.name, settings.law.parameters, blend)
    law.planner(placed_model)  # what it needs is loaded and made here
    return Built(settings, law, placed_model)


def laws_to_choose() -> dict[str, Plug]:
    """Return the laws and whole bodies that can be had, with their parameters."""
    found = usable(law_names(), law_plug)
    return {
        name: Plug(summary(plug), schema(plug), blends_in(plug))
        for name, plug in found.items()
        if not isinstance(plug, str)
    }


def blends_to_choose() -> dict[str, Plug]:
    """Return the blends that can be had, with their parameters."""
    found = usable(names(BLENDS), blend_plug)
    return {name: Plug(summary(plug), schema(plug)) for name, plug in found.items() if not isinstance(plug, str)}


def ordinary() -> None:
    """Give this thread an ordinary priority: it would have that of the loop which starts it."""
    with contextlib.suppress(AttributeError, OSError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


@final
class Builder:
    """Builds settings on a thread of its own, one after the other."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, "settings", ordinary)

    def begin(self, settings: Settings, model: Model) -> Future[Built]:
        """Begin to build; the future holds what came of it, or the SetupError."""
        return self._thread.submit(self._build, settings, model)

    @staticmethod
    def _build(settings: Settings, model: Model) -> Built:
        built = build(settings, model)
        gc.freeze()  # freeze what an import allocated, so that the collector does not scan it while driving
        return built

    def close(self) -> None:
        """Leave what is not begun undone."""
        self._thread.shutdown(wait=False, cancel_futures=True)
