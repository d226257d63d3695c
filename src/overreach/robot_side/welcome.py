"""The first word to an operator: what the robot is, what there is to choose from, what is in force."""

from __future__ import annotations

import secrets
from typing import final

import msgspec

from overreach import __version__
from overreach.control.pilot import Pilot, obeys
from overreach.gate.gate import STALE_S
from overreach.law.frame import axes, frames_of
from overreach.link.messages import PROTOCOL, Settings, Welcome, encode
from overreach.model.handed import hands_of
from overreach.robot_side.settings import Built, blends_to_choose, laws_to_choose, usual

REVISION_BITS = 48
"""Revisions fit into a JavaScript number."""


@final
class Reception:
    """Keeps the welcome ready, encoded: however many hellos come, the loop only sends it."""

    def __init__(self, pilot: Pilot, name: str, rate: float, simulated: bool, defaults: Settings) -> None:
        self._pilot, self._name, self._rate, self._simulated = pilot, name, rate, simulated
        self._defaults = defaults
        self.laws, self.blends = laws_to_choose(pilot.model), blends_to_choose()
        self.revision = secrets.randbits(REVISION_BITS)  # not that of an earlier start
        self.welcome = msgspec.Raw()

    def take(self, built: Built) -> None:
        """Make the welcome anew, for settings that have come into force."""
        self.revision += 1
        if built.settings.hand != self._defaults.hand:  # it has just been chosen: its workspace is whole
            self._defaults = usual(built.model, self._defaults.law)
        model = built.model
        welcome = Welcome(
            protocol=PROTOCOL,
            version=__version__,
            name=self._name,
            model=model.name,
            rate=self._rate,
            limits=self._pilot.gate.limits,
            reach=model.arm.reach,
            obeys=tuple(sorted(obeys(model))),
            hands=hands_of(model),
            axes={frame.value: axes(frame) for frame in frames_of(model.arm)},
            stop_time=STALE_S + 1.0 / self._rate + self._pilot.controller.guard.stop_s,
            max_delay=self._pilot.gate.max_delay,
            simulated=self._simulated,
            laws=self.laws,
            blends=self.blends,
            settings=built.settings,
            defaults=self._defaults,
            scene=built.scene,
            revision=self.revision,
        )
        self.welcome = msgspec.Raw(encode(welcome))
