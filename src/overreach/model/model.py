"""What is known of any robot before it moves: the Protocol that laws, the pilot and robots use."""

from __future__ import annotations

import math
from typing import Protocol

from overreach.arm.chain import Arm
from overreach.arm.mount import Mount
from overreach.errors import WorkspaceError
from overreach.gate.limits import Limits
from overreach.model.base import Base, Start
from overreach.model.workspace import Workspace
from overreach.types import Channel


class Model(Protocol):
    """A base with an arm on it. Frozen; the only place that holds its geometry."""

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
        """Where the arm works alone."""
        ...

    @property
    def start(self) -> Start:
        """Where the hand is at the start."""
        ...

    @property
    def command(self) -> Limits:
        """Full deflection of the stick, and how fast the command may change."""
        ...

    @property
    def bands(self) -> tuple[float, float, float]:
        """Usual widths of the bands in which authority passes: in l [m], psi [rad] and z [m]."""
        ...

    @property
    def gripper(self) -> bool:
        """Whether its hand opens and closes."""
        ...

    def placed(self, mount: Mount, workspace: Workspace) -> Model:
        """Return the same with its arm at another place, and another workspace; raises WorkspaceError."""
        ...


def channels(model: Model) -> tuple[Channel, ...]:
    """Return the channels that are written, in order: the base's, then one per joint."""
    return (*model.base.channels, *model.arm.channels)


def check_workspace(model: Model, workspace: Workspace) -> None:
    """Raise WorkspaceError unless the arm of `model` reaches all of `workspace`, clear of the turning centre."""
    least, most = model.arm.reach
    if workspace.l_min < least or workspace.l_max > most:
        raise WorkspaceError(
            f"the workspace's l = {workspace.l_min:g} to {workspace.l_max:g} m is not within "
            f"the arm's reach of {least:g} to {most:g} m"
        )
    if not model.base.omni:
        _check_centre(workspace, model.mount)


def check_reach(model: Model, l: float) -> None:
    """Raise WorkspaceError unless the hand can be l [m] from the shoulder, strictly within the arm's reach."""
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
