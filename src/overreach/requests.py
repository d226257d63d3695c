"""What may be asked of the robot side besides motion; each request is answered."""

from __future__ import annotations

from overreach.types import Record


class StopRequest(Record, frozen=True, tag="stop"):
    """Latch the stop."""


class ResetRequest(Record, frozen=True, tag="reset"):
    """Release the latches of stop and fault; moves nothing, arms nothing."""


class ArmRequest(Record, frozen=True, tag="arm"):
    """Arm for this operator; its presses of the dead-man up to number `grip` do not count."""

    operator: int
    grip: int = 0


class DisarmRequest(Record, frozen=True, tag="disarm"):
    """Disarm, if this operator armed."""

    operator: int


class RestartRequest(Record, frozen=True, tag="restart"):
    """Put a simulated robot back to its start; refused unless it is disarmed and at rest."""


Request = StopRequest | ResetRequest | ArmRequest | DisarmRequest | RestartRequest
