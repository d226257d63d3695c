"""From a description and its model to the parts of a robot: arm, mount, base, contacts, and the model's hash."""

from __future__ import annotations

import hashlib
import math
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import mujoco

from overreach.arm.mount import Mount
from overreach.arm.spatial.arm import SpatialArm
from overreach.arm.spatial.manner import Manner
from overreach.arm.spatial.side import Drive, SideArm
from overreach.errors import SetupError
from overreach.model.base import Base
from overreach.model.description import BaseTable, Description
from overreach.model.measure.rank import farthest
from overreach.model.mujoco.chain import extract
from overreach.model.mujoco.contact import Contacts
from overreach.model.mujoco.source import compiled, spec_of
from overreach.model.mujoco.wheels import wheels_of
from overreach.types import Channel

CONTACT = 0.022
"""Bodies may come as close as this, in parts of R."""
ALGORITHM = "5"
"""To be changed with the algorithm that measures."""
OFF_ACROSS = 10.0
"""How far [degrees] an arm that moves its hand along one line may point off square to the way that its base drives."""
STILL_M, STILL_RAD = 0.01, 0.105
"""Rates [m/s, rad/s] below which a joint may stand still."""


class Parts(NamedTuple):
    """A described robot without a workspace."""

    description: Description
    arm: SpatialArm
    mount: Mount
    base: Base
    model: mujoco.MjModel
    key: str
    warnings: list[str]

    def contacts(self, part: float = 1.0) -> Contacts:
        """Return what tells of the arm touching its robot; part: of the usual distances."""
        return Contacts(self.model, self.description, CONTACT * self.arm.manner.reach, part)


def parts_of(description: Description, folder: Path) -> Parts:
    """Return the parts of a described robot; its arm's manner knows the reach only. Raises SetupError."""
    source = spec_of(description.model, folder)
    model = compiled(source.spec, f"the model {description.model!r}")
    found = extract(model, description)
    channels = []
    rows = zip(
        description.arm.groups, found.units, description.arm.speed, description.arm.acceleration, found.lower,
        found.upper, description.home, strict=True,
    )  # fmt: skip
    for group, unit, speed, change, lower, upper, at in rows:
        name = group[0]
        if not lower <= at <= upper:
            raise SetupError(f"home: joint {name!r} is at {at:g} {unit}, outside its limits {lower:g} to {upper:g}")
        still = STILL_M if unit == "m" else STILL_RAD
        channels.append(
            Channel(f"dq_{name}", name, unit, speed, change, lower, upper, dead_band=min(still, 0.5 * speed))
        )
    approach = description.hand.approach
    size = sum(one * one for one in approach) ** 0.5
    if not size > 0.0:
        raise SetupError("hand.approach must be an axis, not 0")
    manner = Manner(1.0, 0.1, approach=(approach[0] / size, approach[1] / size, approach[2] / size))
    table = description.base
    own = tuple(channels), found.screws, found.tip, description.home, manner
    if found.aside:
        _check_across(found.mount, table)
        arm: SpatialArm = SideArm(*own, Drive(found.mount.yaw, table.v_max, table.w_max), compiled=False)
    else:
        arm = SpatialArm(*own, compiled=False)
    arm = arm.held(msgspec.structs.replace(arm.manner, reach=farthest(arm)))
    wheels = wheels_of(model, description)
    base = Base(
        table.v_max, table.w_max, table.dv_max, table.dw_max, table.footprint, table.lag, table.kind == "omni", wheels
    )  # fmt: skip
    return Parts(description, arm, found.mount, base, model, _key(model, description), source.warnings)


def _check_across(mount: Mount, base: BaseTable) -> None:
    """Raise SetupError where a base cannot take what an arm that moves its hand along one line leaves to it."""
    off = math.degrees(math.acos(min(1.0, abs(math.sin(mount.yaw)))))
    if base.kind == "omni" or off > OFF_ACROSS:
        why = (
            "on an omni base" if base.kind == "omni" else
            f"that lies {off:.0f} degrees off square to the way that the base drives"
        )  # fmt: skip
        raise SetupError(
            f"at home the arm moves its hand along one line only, {why}: no law is for that. The law 'exact' needs an "
            "arm that also moves its hand about its shoulder; the law 'side' a differential base whose way is square "
            f"to that line, to {OFF_ACROSS:.0f} degrees"
        )


def _key(model: mujoco.MjModel, description: Description) -> str:
    """Return the hash of what a workspace depends on."""
    digest = hashlib.sha256(ALGORITHM.encode())
    for name in (
        "body_parentid", "body_pos", "body_quat", "jnt_type", "jnt_pos", "jnt_axis", "jnt_range", "jnt_limited",
        "jnt_bodyid", "geom_type", "geom_bodyid", "geom_pos", "geom_quat", "geom_size", "geom_contype",
        "geom_conaffinity", "mesh_vert", "exclude_signature", "qpos0",
    ):  # fmt: skip
        values = getattr(model, name)
        digest.update((values.round(6) + 0.0 if values.dtype.kind == "f" else values).tobytes())
    own = msgspec.structs.replace(description, workspace={}, name="", summary="", model="")
    told: dict[str, Any] = msgspec.to_builtins(own)
    for name in ("mode", "hands", "driven", "others"):
        del told[name]
    if not told["arm"]["never_touch"]:
        del told["arm"]["never_touch"]
    told["mount"]["yaw"] = description.mount.yaw or 0.0
    digest.update(msgspec.json.encode(told))
    return digest.hexdigest()[:16]
