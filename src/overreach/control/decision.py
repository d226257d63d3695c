"""What a controller decides for one period."""

from __future__ import annotations

from overreach.types import BaseTwist, HandTwist, PolarState, Record, RobotState, Split
from overreach.verdicts import Verdict


class Decision(Record, frozen=True):
    """What a controller decided for one period.

    state: the newest believed state of the robot; polar: where the hand is; u: its commanded velocity; split: the
    shares, with the rates as they are written; joints: joint rates [rad/s, m/s]; scale: part of the command that is
    carried out; verdict: MOVING, or why it is less; fault: the reason where the verdict is FAULT, else empty; reason:
    what limits the hand, in words, where there is more to say than the verdict does; attitude: the one that the hand
    holds at bearing 0, by rows, None: home's.
    """

    state: RobotState
    polar: PolarState
    u: HandTwist
    split: Split
    joints: tuple[float, ...]
    scale: float
    verdict: Verdict
    fault: str = ""
    reason: str = ""
    attitude: tuple[float, ...] | None = None

    @property
    def base(self) -> BaseTwist:
        """The base twist that is written."""
        return BaseTwist(self.split.v_b, self.split.v_y or 0.0, self.split.w_b)

    @property
    def rates(self) -> tuple[float, ...]:
        """All that is written, channel by channel."""
        split = self.split
        if split.v_y is None:
            return (split.v_b, split.w_b, *self.joints)
        return (split.v_b, split.v_y, split.w_b, *self.joints)
