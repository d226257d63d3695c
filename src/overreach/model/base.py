"""The mobile base, and where the hand starts."""

from __future__ import annotations

import math

from overreach.errors import SetupError
from overreach.types import BaseTwist, Channel, Record

LONGEST_LAG_S = 1.0
STILL_M, STILL_RAD = 0.03, 0.105
"""Rates [m/s, rad/s] below which a base may stand still."""


class Wheel(Record, frozen=True):
    """Where a wheel stands in the base frame (x, y [m]), the way that it rolls [rad], and its radius [m]."""

    x: float
    y: float
    heading: float
    radius: float


class Base(Record, frozen=True):
    """A base on wheels: v_max [m/s], w_max [rad/s], dv_max [m/s^2], dw_max [rad/s^2]; footprint: length, width [m].

    lag: time constant [s] with which the base follows a request; 0 if it follows at once or the lag is not known; omni:
    whether it moves sideways as well, on mecanum or omni wheels; wheels: those that drive it, where they are known.
    """

    v_max: float
    w_max: float
    dv_max: float
    dw_max: float
    footprint: tuple[float, float]
    lag: float = 0.0
    omni: bool = False
    wheels: tuple[Wheel, ...] = ()

    def __post_init__(self) -> None:
        for name in ("v_max", "w_max", "dv_max", "dw_max"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise SetupError(f"base {name} must be a finite number > 0, got {value:g}")
        if not 0.0 <= self.lag <= LONGEST_LAG_S:
            raise SetupError(f"base lag must be 0 to {LONGEST_LAG_S:g} s, got {self.lag:g}")

    @property
    def channels(self) -> tuple[Channel, ...]:
        """The rates that are written to it: v_b, w_b; of one that moves sideways too, v_b_x, v_b_y, w_b."""
        place, heading = "the base's place", "the base's heading"
        return (
            *[Channel(name, place, "m", self.v_max, self.dv_max, dead_band=STILL_M) for name in self._names],
            Channel("w_b", heading, "rad", self.w_max, self.dw_max, dead_band=STILL_RAD),
        )

    @property
    def _names(self) -> tuple[str, ...]:
        return ("v_b_x", "v_b_y") if self.omni else ("v_b",)

    @property
    def axes(self) -> int:
        """How many rates are written to it: the first ones of a robot's channels."""
        return 3 if self.omni else 2

    def rates(self, twist: BaseTwist) -> tuple[float, ...]:
        """Return a twist as its rates, in the order of its channels."""
        return (twist.v_x, twist.v_y, twist.w_z) if self.omni else (twist.v_x, twist.w_z)

    def twist(self, rates: tuple[float, ...]) -> BaseTwist:
        """Return the twist that the first of a robot's rates mean."""
        return BaseTwist(rates[0], rates[1], rates[2]) if self.omni else BaseTwist(rates[0], 0.0, rates[1])


class Start(Record, frozen=True):
    """Where the hand is when the robot starts: l [m], psi [rad]."""

    l: float
    psi: float
