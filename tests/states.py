"""States of a robot with one number changed."""

from __future__ import annotations

import msgspec

from overreach.types import RobotState

WITHIN = {
    "x_b": ("pose", "x"), "y_b": ("pose", "y"), "theta_b": ("pose", "heading"),
    "v_b": ("motion", "v_x"), "w_b": ("motion", "w_z"),
}  # fmt: skip
JOINTS = {"theta": "q", "dtheta": "dq"}


def put(state: RobotState, field: str, value: float) -> RobotState:
    """Return `state` with one number changed."""
    name, _, k = field.rpartition("_")
    if name in JOINTS and k.isdigit():
        joints = list(getattr(state, JOINTS[name]))
        joints[int(k) - 1] = value
        return msgspec.structs.replace(state, **{JOINTS[name]: tuple(joints)})
    if field in WITHIN:
        part, inner = WITHIN[field]
        return msgspec.structs.replace(state, **{part: msgspec.structs.replace(getattr(state, part), **{inner: value})})
    return msgspec.structs.replace(state, **{field: value})


def got(state: RobotState, field: str) -> float:
    """Return one number of `state`."""
    name, _, k = field.rpartition("_")
    if name in JOINTS and k.isdigit():
        return float(getattr(state, JOINTS[name])[int(k) - 1])
    return float(getattr(state, field))
