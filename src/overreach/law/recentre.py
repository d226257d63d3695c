"""While the base carries the hand it goes a little faster than the hand, until the arm is back at mid-reach.

The hand does not notice: the arm closes what the base does more. How far a drive has come to be carried is one number,
which the controller keeps, so that laws stay pure:

    k_1 = min(1, k + mu^2 |u_r| dt / way)    while u_r keeps its sign; 0 once it turns round, or the hand is let go
    mu' = mu + k (1 + ratio h(x) - mu)       x: how far the arm is from mid-reach, in parts of `over`; h(x) = x (2 - x)

Rates are continuous: k grows with the distance, and at the turn u_r is 0. mu' >= mu: the hand stays in its band. The
square keeps k small until the base has taken over: the joints that brake for the band should not brake for k as well.
Source: this project.
"""

from __future__ import annotations

from overreach.model.model import Model
from overreach.types import HandTwist, Record

RATIO = 0.25
"""The base goes faster than the hand by this part of the hand's speed ..."""
SPARE = 0.95
"""... and, with it, by no more than this part of its own greatest speed."""
OVER = 0.5
"""Nearer to mid-reach than this part of what lies between it and the outer limit, the base's lead fades."""
USUAL, ON, OFF = "usual", "on", "off"
CHOICES = (USUAL, ON, OFF)
"""On where the workspace was measured; always; never."""


class Carried(Record, frozen=True):
    """How far a drive has come to be carried by the base, 0 to 1, and its sense: 1 outward, -1 inward, 0 neither."""

    part: float = 0.0
    sense: float = 0.0


NOT_CARRIED = Carried()


class Centring(Record, frozen=True):
    """Bound to a robot. way: how far the base carries the hand until it counts as carried [m]."""

    way: float

    def along(self, u: HandTwist) -> float:
        """Return the part of the hand's velocity [m/s] that the base carries: whose way counts, and whose sense."""
        raise NotImplementedError

    def now(self, before: Carried, along: float) -> Carried:
        """Return what counts for a period at `along` [m/s]: nothing of a drive in the other sense."""
        sense = 1.0 if along > 0.0 else -1.0 if along < 0.0 else 0.0
        return before if sense == before.sense else Carried(0.0, sense)

    def after(self, now: Carried, mu: float, along: float, dt: float) -> Carried:
        """Return what `now` has come to after a period `dt` [s] at `along` [m/s], of which the base had the part mu."""
        return Carried(min(1.0, now.part + mu**2 * abs(along) * dt / self.way), now.sense)


class Recentring(Centring, frozen=True):
    """That of `exact`. middle: mid-reach [m]; over [m]; ratio: of the base's lead."""

    middle: float
    over: float
    ratio: float

    def along(self, u: HandTwist) -> float:
        """The base carries u_r."""
        return u.u_r

    def lead(self, l: float, sense: float) -> float:
        """Return by which part of the hand's speed the base leads, for the hand at l [m] and a sense of the drive."""
        x = min(1.0, sense * (l - self.middle) / self.over)
        return self.ratio * x * (2.0 - x) if x > 0.0 else 0.0


def recentring(model: Model, chosen: str) -> Recentring | None:
    """Return how a robot is re-centred, None if it is not. chosen: one of CHOICES."""
    space = model.workspace
    if chosen == OFF or (chosen == USUAL and not space.edges):
        return None
    half = 0.5 * (space.l_max - space.l_min)
    ratio = min(RATIO, SPARE * model.base.v_max / model.command.v_c - 1.0)
    return Recentring(half, space.l_min + half, OVER * half, ratio) if ratio > 0.0 else None
