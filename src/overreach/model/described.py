"""A robot in 3-D, from its maker's model file and a description: `overreach.model.model.Model`."""

from __future__ import annotations

from typing import final

from overreach.arm.mount import Mount
from overreach.arm.spatial.arm import SpatialArm
from overreach.errors import WorkspaceError
from overreach.gate.limits import Limits
from overreach.model.base import Base, Start
from overreach.model.workspace import WIDEST, Workspace

BAND = 0.067
"""Width of the bands in l and z, in parts of the arm's reach R ..."""
BAND_PSI = 0.3
"""... and in psi [rad]."""
BAND_ASIDE = 0.37
"""Width of the band in l of an arm that moves its hand along one line only, in parts of the sector's: the base swings
by a quarter in it. What is left between the two is for reaching."""
CLEAR = 0.3
"""The hand starts with this much [rad] of bearing to either side, where the sector has it."""


@final
class DescribedRobot:
    """A robot with its arm held in one manner, and the workspace that was measured for it."""

    def __init__(
        self, name: str, summary: str, arm: SpatialArm, mount: Mount, base: Base, workspace: Workspace, command: Limits,
        gripper: bool, mode: str,
    ) -> None:  # fmt: skip
        self.name, self.summary, self.arm, self.mount, self.base = name, summary, arm, mount, base
        self.workspace, self.command, self.gripper, self.mode = workspace, command, gripper, mode

    @property
    def start(self) -> Start:
        """Midway in l, as near as can be to straight ahead."""
        space = self.workspace
        room = min(CLEAR, 0.5 * (space.psi_max - space.psi_min))
        return Start(0.5 * (space.l_min + space.l_max), min(max(0.0, space.psi_min + room), space.psi_max - room))

    @property
    def bands(self) -> tuple[float, float, float]:
        """Usual widths of the bands in l [m], psi [rad] and z [m]."""
        space, R = self.workspace, self.arm.manner.reach
        widest_l, widest_psi = space.widest
        band = BAND_ASIDE * (space.l_max - space.l_min) if self.arm.aside else min(BAND * R, widest_l)
        return band, min(BAND_PSI, widest_psi), min(BAND * R, WIDEST * (space.z_max - space.z_min))

    def placed(self, mount: Mount, workspace: Workspace) -> DescribedRobot:
        """Return the same with another workspace, inside the one that was measured; raises WorkspaceError."""
        own = self.workspace
        if mount != self.mount:
            raise WorkspaceError(f"the shoulder of {self.name} is where its model has it: {self.mount}")
        if workspace != own:
            within = own.contains(workspace.l_min, workspace.psi_min) and own.contains(
                workspace.l_max, workspace.psi_max
            )
            if not (within and own.z_min <= workspace.z_min and workspace.z_max <= own.z_max and workspace.edges):
                raise WorkspaceError(
                    f"a workspace of {self.name} lies inside the measured one: l = {own.l_min:g} to {own.l_max:g} m, "
                    f"psi = {own.psi_min:g} to {own.psi_max:g} rad, z = {own.z_min:g} to {own.z_max:g} m"
                )
        return self.driven_in(workspace)

    def driven_in(self, workspace: Workspace) -> DescribedRobot:
        """Return the same with any workspace: whether the arm can hold its hand there is not looked at."""
        return DescribedRobot(
            self.name, self.summary, self.arm, self.mount, self.base, workspace, self.command, self.gripper, self.mode
        )
