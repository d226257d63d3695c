"""The part of the plane in which the arm works alone: an annular sector about the shoulder."""

from __future__ import annotations

import math

from overreach.errors import WorkspaceError
from overreach.types import Record


class Workspace(Record, frozen=True):
    """L_min <= l <= L_max [m], Psi_min <= psi <= Psi_max [rad], about the shoulder.

    Raises WorkspaceError unless all are finite, 0 < L_min < L_max and
    -pi <= Psi_min < Psi_max <= pi. Source: Kwon et al. 2026, Fig. 4.
    """

    l_min: float
    l_max: float
    psi_min: float
    psi_max: float

    def __post_init__(self) -> None:
        values = (self.l_min, self.l_max, self.psi_min, self.psi_max)
        if not all(math.isfinite(value) for value in values):
            raise WorkspaceError(f"workspace limits must be finite numbers, got {values}")
        if not 0.0 < self.l_min < self.l_max:
            raise WorkspaceError(
                f"workspace needs 0 < l_min < l_max [m], got l_min = {self.l_min:g}, l_max = {self.l_max:g}"
            )
        if not -math.pi <= self.psi_min < self.psi_max <= math.pi:
            raise WorkspaceError(
                "workspace needs -pi <= psi_min < psi_max <= pi [rad], "
                f"got psi_min = {self.psi_min:g}, psi_max = {self.psi_max:g}"
            )

    def contains(self, l: float, psi: float, margin_l: float = 0.0, margin_psi: float = 0.0) -> bool:
        """Say whether (l [m], psi [rad]) lies in the workspace widened by the margins."""
        return (
            self.l_min - margin_l <= l <= self.l_max + margin_l
            and self.psi_min - margin_psi <= psi <= self.psi_max + margin_psi
        )
