"""The part of the world in which the arm works alone: an annular sector about the shoulder, between two heights."""

from __future__ import annotations

import math

from overreach.errors import WorkspaceError
from overreach.types import Record

WIDEST = 0.4
"""A band inside the edges is at most this part of the way from one edge to the other."""


class Workspace(Record, frozen=True):
    """L_min <= l <= L_max [m], Psi_min <= psi <= Psi_max [rad], about the shoulder; Z_min <= z <= Z_max [m].

    edges: whether these are outer edges, which the hand does not leave, as they are measured: a law's own limits, the
    middles of its blends, then lie half a band inside. Else, as in the paper, they are the middles themselves. Raises
    WorkspaceError unless l and psi are finite, 0 < L_min < L_max, -pi <= Psi_min < Psi_max <= pi and Z_min < Z_max.
    Source: Kwon et al. 2026, Fig. 4.
    """

    l_min: float
    l_max: float
    psi_min: float
    psi_max: float
    z_min: float = -math.inf
    z_max: float = math.inf
    edges: bool = False

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

        if not self.z_min < self.z_max:
            raise WorkspaceError(
                f"workspace needs z_min < z_max [m], got z_min = {self.z_min:g}, z_max = {self.z_max:g}"
            )

    @property
    def widest(self) -> tuple[float, float]:
        """The widest bands in l [m] and psi [rad] that leave something between them; endless where none are outer."""
        if not self.edges:
            return math.inf, math.inf
        return WIDEST * (self.l_max - self.l_min), WIDEST * (self.psi_max - self.psi_min)

    def middles(self, width_l: float, width_psi: float) -> tuple[float, float, float, float]:
        """Return a law's own limits (l_min, l_max, psi_min, psi_max), for bands of these widths [m, rad]."""
        if not self.edges:
            return self.l_min, self.l_max, self.psi_min, self.psi_max
        q, p = 0.5 * width_l, 0.5 * width_psi
        return self.l_min + q, self.l_max - q, self.psi_min + p, self.psi_max - p

    def contains(self, l: float, psi: float, margin_l: float = 0.0, margin_psi: float = 0.0) -> bool:
        """Say whether (l [m], psi [rad]) lies in the workspace widened by the margins."""
        return (
            self.l_min - margin_l <= l <= self.l_max + margin_l
            and self.psi_min - margin_psi <= psi <= self.psi_max + margin_psi
        )
