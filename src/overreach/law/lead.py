"""Where the hand will be, seen from a base that follows late: a pure function of floats."""

from __future__ import annotations

from math import cos, sin

from overreach.law.authority import Mount3, arm_residual

L_LEAST = 1e-6
"""A hand is never asked for nearer to the shoulder than this [m]."""


def lead(
    l: float,
    psi: float,
    u_r: float,
    u_t: float,
    v_b: float,
    w_b: float,
    lag: float,
    mount: Mount3,
) -> tuple[float, float, float, float]:
    """Return (l, psi, u_r, u_t) as they are to be shown to a law whose base follows with the time constant `lag` [s].

    (v_b, w_b) is the base twist that is happening, (v_m, w_m) what the arm must do against it. A base that lags by T
    will have left T v_m and T w_m more to the arm when it has caught up:
        l + T v_m,   psi + T w_m,   and the same velocity, seen along that bearing.
    Pushed straight on, d/dt (l + T v_m) = (1 - mu) u_r: shares taken there keep l in the band that a base without lag
    keeps it in. Source: this project (docs/why.md).
    """
    v_m, w_m = arm_residual(l, psi, u_r, u_t, v_b, w_b, mount)
    turn = lag * w_m
    c, s = cos(turn), sin(turn)
    return max(L_LEAST, l + lag * v_m), psi + turn, u_r * c + u_t * s, u_t * c - u_r * s
