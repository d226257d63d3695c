"""What is known of a robot before it moves, whatever it is made of: the Protocol that law, pilot and robots meet."""

from __future__ import annotations

import math
from typing import Any, Protocol, cast

import msgspec

from overreach.arm.chain import Arm
from overreach.arm.mount import Mount
from overreach.errors import WorkspaceError
from overreach.model.base import Base, Start
from overreach.model.workspace import Workspace
from overreach.types import Channel


class Model(Protocol):
    """A base with an arm on it. Frozen; the one place where its geometry is told."""

    @property
    def name(self) -> str:
        """The name under which it is chosen."""
        ...

    @property
    def summary(self) -> str:
        """One line about it."""
        ...

    @property
    def base(self) -> Base:
        """The base's limits."""
        ...

    @property
    def arm(self) -> Arm:
        """The arm's joints and kinematics."""
        ...

    @property
    def mount(self) -> Mount:
        """Where the arm stands on the base."""
        ...

    @property
    def workspace(self) -> Workspace:
        """Where the arm is to work alone."""
        ...

    @property
    def start(self) -> Start:
        """Where the hand is at the start."""
        ...

    @property
    def gripper(self) -> bool:
        """Whether its hand opens and closes."""
        ...


def channels(model: Model) -> tuple[Channel, ...]:
    """Return the rates that are written, in order: the base's, then one a joint."""
    return (*model.base.channels, *model.arm.channels)


def placed(model: Model, mount: Mount, workspace: Workspace) -> Model:
    """Return `model` with its arm at another place, and another workspace."""
    changed: Any = msgspec.structs.replace(model, mount=mount, workspace=workspace)  # type: ignore[type-var]
    return cast(Model, changed)


def check_workspace(model: Model, workspace: Workspace) -> None:
    """Raise WorkspaceError unless the arm of `model` reaches the whole of `workspace`, beside the turning centre."""
    least, most = model.arm.reach
    if workspace.l_min < least or workspace.l_max > most:
        raise WorkspaceError(
            f"the workspace's l = {workspace.l_min:g} to {workspace.l_max:g} m is not within "
            f"the arm's reach of {least:g} to {most:g} m"
        )
    _check_centre(workspace, model.mount)


def check_reach(model: Model, l: float) -> None:
    """Raise WorkspaceError unless the hand can be l [m] from the shoulder, short of its singularities."""
    least, most = model.arm.reach
    if not least < l < most:
        raise WorkspaceError(f"the arm cannot reach l = {l:g} m: valid are {least:g} < l < {most:g} m")


def _check_centre(workspace: Workspace, mount: Mount) -> None:
    """Raise WorkspaceError where the EE could come over the base's turning centre."""
    worst = workspace.l_min - math.hypot(mount.s_x, mount.s_y)
    if worst <= 0.0:
        # Only a shoulder behind the hand brings it over the turning centre: look at the whole sector.
        steps = 64
        span = workspace.psi_max - workspace.psi_min
        for k in range(steps + 1):
            psi_d = workspace.psi_min + span * k / steps + mount.yaw
            if workspace.l_min + mount.s_x * math.cos(psi_d) + mount.s_y * math.sin(psi_d) <= 0.0:
                raise WorkspaceError(
                    f"with the shoulder at ({mount.s_x:g}, {mount.s_y:g}) m the hand comes over the base's "
                    f"turning centre inside the workspace: choose l_min > {-worst + workspace.l_min:g} m"
                )
