"""The mobile base, and where the hand starts."""

from __future__ import annotations

import math

from overreach.errors import SetupError
from overreach.types import Channel, Record

LONGEST_LAG_S = 1.0


class Base(Record, frozen=True):
    """A base on wheels: v_max [m/s], w_max [rad/s], dv_max [m/s^2], dw_max [rad/s^2]; footprint: length, width [m].

    lag: time constant [s] with which the base follows a request; 0 if it follows at once or the lag is not known.
    """

    v_max: float
    w_max: float
    dv_max: float
    dw_max: float
    footprint: tuple[float, float]
    lag: float = 0.0

    def __post_init__(self) -> None:
        for name in ("v_max", "w_max", "dv_max", "dw_max"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise SetupError(f"base {name} must be a finite number > 0, got {value:g}")
        if not 0.0 <= self.lag <= LONGEST_LAG_S:
            raise SetupError(f"base lag must be 0 to {LONGEST_LAG_S:g} s, got {self.lag:g}")

    @property
    def channels(self) -> tuple[Channel, ...]:
        """The rates that are written to a base that cannot move sideways: v_b, w_b."""
        return (
            Channel("v_b", "the base's place", "m", self.v_max, self.dv_max, dead_band=0.03),
            Channel("w_b", "the base's heading", "rad", self.w_max, self.dw_max, dead_band=0.105),
        )


class Start(Record, frozen=True):
    """Where the hand is when the robot starts: l [m], psi [rad]."""

    l: float
    psi: float
