"""Random but valid states, commands and robots for Hypothesis."""

from __future__ import annotations

import math

from hypothesis import strategies as st

from overreach.arm.mount import Mount
from overreach.law.blend import Blend, Smoothstep, Step, Tanh
from overreach.model.workspace import Workspace

WORKSPACE = Workspace(0.45, 0.85, -0.6, 0.6)
MOUNT_FREE = Mount()

lengths = st.floats(0.42, 0.95)
bearings = st.floats(-0.75, 0.75)
speeds = st.floats(-0.4, 0.4)
angles = st.floats(-math.pi, math.pi)
mounts = st.builds(Mount, st.floats(-0.2, 0.3), st.floats(-0.2, 0.2), st.floats(-0.5, 0.5))
blends = st.one_of(
    st.builds(Tanh, st.floats(5.0, 200.0), st.floats(5.0, 200.0)),
    st.builds(Smoothstep, st.floats(0.01, 0.2), st.floats(0.01, 0.3)),
    st.just(Step()),
)


def limits_of(workspace: Workspace, blend: Blend) -> tuple[float, float, float, float, float, float]:
    """Return the six numbers that the law's functions take."""
    return (
        workspace.l_min, workspace.l_max, workspace.psi_min, workspace.psi_max, blend.k_l, blend.k_psi
    )  # fmt: skip
