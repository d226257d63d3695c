"""Where the hand will be once a lagging base has caught up: a pure function of floats."""

from __future__ import annotations

from math import cos, sin

from overreach.law.authority import Mount3, arm_residual

L_LEAST = 1e-6
"""A law is never asked about a hand nearer to the shoulder than this [m]."""


def lead(
    l: float,
    psi: float,
    u_r: float,
    u_t: float,
    v_b: float,
    w_b: float,
    lag: float,
    mount: Mount3,
    v_y: float = 0.0,
) -> tuple[float, float, float, float]:
    """Return the (l, psi, u_r, u_t) to give to a law whose base follows with the time constant `lag` [s].

    (v_b, w_b), and v_y to its left, is the present base twist, (v_m, w_m) what the arm must add to it. By the time a
    base that lags by T has caught up, it will have left T v_m and T w_m more to the arm:
        l + T v_m,   psi + T w_m,   and the same velocity, seen along that bearing.
    Pushed straight on, d/dt (l + T v_m) = (1 - mu) u_r: shares taken there keep l in the band that a base without lag
    keeps it in. Source: this project (docs/why.md).
    """
    v_m, w_m = arm_residual(l, psi, u_r, u_t, v_b, w_b, mount, v_y)
    turn = lag * w_m
    c, s = cos(turn), sin(turn)
    return max(L_LEAST, l + lag * v_m), psi + turn, u_r * c + u_t * s, u_t * c - u_r * s
