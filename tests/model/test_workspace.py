from __future__ import annotations

import math

import pytest

from overreach.arm.mount import Mount
from overreach.errors import WorkspaceError
from overreach.model.planar import planar
from overreach.model.workspace import Workspace
from tests.strategies import WORKSPACE


@pytest.mark.parametrize(
    "limits",
    [
        (0.85, 0.45, -0.6, 0.6),
        (0.5, 0.5, -0.6, 0.6),
        (0.0, 0.85, -0.6, 0.6),
        (-0.1, 0.85, -0.6, 0.6),
        (0.45, 0.85, 0.6, -0.6),
        (0.45, 0.85, -4.0, 0.6),
        (math.nan, 0.85, -0.6, 0.6),
        (0.45, math.inf, -0.6, 0.6),
    ],
)
def test_impossible_workspaces_are_refused(limits: tuple[float, float, float, float]) -> None:
    """A workspace whose limits are out of order or not finite cannot be made."""
    with pytest.raises(WorkspaceError):
        Workspace(*limits)


def test_hand_over_the_turning_centre_is_refused() -> None:
    """A mount that lets the hand come over the base's turning centre is refused when the robot is described."""
    with pytest.raises(WorkspaceError, match="turning centre"):
        planar(mount=Mount(-0.6, 0.0, 0.0))
    planar(mount=Mount(0.6, 0.0, 0.0))


def test_contains() -> None:
    """The workspace contains its own edge and, widened, what lies just beyond."""
    space = WORKSPACE
    assert space.contains(0.45, 0.6)
    assert not space.contains(0.86, 0.0)
    assert space.contains(0.86, 0.0, margin_l=0.02)
    assert not space.contains(0.6, 0.61)
