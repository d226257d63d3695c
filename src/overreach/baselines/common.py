"""What the baselines have in common: from base and joint rates to a `Split`."""

from __future__ import annotations

from math import cos, sin

from overreach.law.workspace import Mount
from overreach.types import Split, Verdict

NO_SOLUTION = Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, Verdict.NO_SOLUTION)
"""What a law gives whose solver failed: zero, and why."""


def part(base: float, whole: float) -> float:
    """Return base/whole held to [0, 1]: the base's share of a motion; 0 of no motion at all."""
    if whole == 0.0:
        return 0.0
    return max(0.0, min(1.0, base / whole))


def shared(
    psi: float, mount: Mount, u_r: float, v_b: float, w_b: float, dtheta: tuple[float, float], j_l: float, j_psi: float
) -> Split:
    """Return base and joint rates as a `Split`, with the arm's polar rates and the shares read off them.

    mu = (c v_b + k_r w_b)/u_r, the base's part of the radial motion, sigma = w_b/(w_b + w_m), both held to [0, 1].
    """
    psi_d = psi + mount.yaw
    c, sn = cos(psi_d), sin(psi_d)
    radial = c * v_b + (mount.s_x * sn - mount.s_y * c) * w_b
    v_m, w_m = j_l * dtheta[1], dtheta[0] + j_psi * dtheta[1]
    return Split(part(radial, u_r), part(w_b, w_b + w_m), v_b, w_b, v_m, w_m, dtheta=dtheta)
