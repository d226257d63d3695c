"""What may be asked of the robot side besides motion; each request is answered."""

from __future__ import annotations

import msgspec


class StopRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="stop"):
    """Latch the stop."""


class ResetRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="reset"):
    """Release the latches of stop and fault; moves nothing, arms nothing."""


class ArmRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="arm"):
    """Arm for this operator; its presses of the dead-man up to number `grip` do not count."""

    operator: int
    grip: int = 0


class DisarmRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="disarm"):
    """Disarm, if this operator armed."""

    operator: int


class RestartRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="restart"):
    """Put a simulated robot back to its start; refused unless it is disarmed and at rest."""


Request = StopRequest | ResetRequest | ArmRequest | DisarmRequest | RestartRequest
