"""The rival for many robots: the full planar step written with numpy's array operations, as one would without numba."""

from __future__ import annotations

import numpy as np

from overreach.arm.planar import SINE_DAMPED
from overreach.fast.batch import Array
from overreach.law.authority import BASE_GAIN, HUGE, Limits6


def numpy_step(states: Array, rates: Array, limits: Limits6, a: float, b: float) -> None:
    """Write the rates (4, n) for the states (6, n): `fast.step.planar_step`, smoothstep, shoulder at the base's centre.

    Where the arm is almost straight or folded, its damping is applied as in `arm.planar.joint_rates`.
    """
    theta_1, theta_2, theta_b, theta_e, v_c, w_c = states
    l_min, l_max, psi_min, psi_max, q_l, q_psi = limits
    c2, s2 = np.cos(theta_2), np.sin(theta_2)
    e, f = a + b * c2, b * s2
    l = np.sqrt(e * e + f * f)
    psi = theta_1 + np.arctan2(f, e)
    delta = theta_e - theta_b - psi
    u_r, u_t = v_c * np.cos(delta), v_c * np.sin(delta) + w_c * l

    g = np.where(u_r >= 0.0, 1.0, -1.0)
    mu = _smoothstep(np.where(u_r >= 0.0, l - l_max, l_min - l), q_l)
    c, sn = np.cos(psi), np.sin(psi)
    drives = mu * u_r != 0.0
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        t = u_t / u_r
        one = 1.0 + t * t
        beside = drives & (mu * mu > BASE_GAIN**2 * one * c * c)
        speed = np.hypot(u_r, u_t)
        part = BASE_GAIN * speed * np.abs(c) / np.abs(mu * u_r)
        v_b = np.where(beside, np.copysign(BASE_GAIN * speed * part, mu * u_r * c), mu * u_r / c)
        scale = np.where(beside, part * part, 1.0)
        eta = psi + np.arctan(t)
        eta -= np.where(np.abs(eta) > np.pi, np.copysign(2.0 * np.pi, eta), 0.0)
        w_l = v_b * (2.0 * g * eta - t / np.sqrt(one)) / l
    v_b = np.where(drives, v_b, 0.0)
    w_l = np.where(drives & (one < HUGE), w_l, 0.0)
    u_r, u_t = u_r * scale, u_t * scale
    d = u_t + v_b * sn
    w_des = d - l * w_l
    sigma = _smoothstep(np.where(w_des >= 0.0, psi - psi_max, psi_min - psi), q_psi)
    w_b = sigma * d / l + (1.0 - sigma) * w_l
    v_m, w_m = u_r - c * v_b, d / l - w_b

    near = np.abs(s2) < SINE_DAMPED
    with np.errstate(divide="ignore", invalid="ignore"):
        free = -v_m * l / (a * b * s2)
    towards = near & ((v_m > 0.0) == (c2 > 0.0))
    held = np.copysign(SINE_DAMPED, np.where(s2 != 0.0, s2, 1.0))
    bounded = np.where(towards, -v_m * l * s2 / (a * b * SINE_DAMPED**2), -v_m * l / (a * b * held))
    rates[3] = np.where(near, bounded, free)
    rates[2] = w_m - b * (b + a * c2) / (l * l) * rates[3]
    rates[0] = v_b
    rates[1] = w_b


def _smoothstep(e: Array, q: float) -> Array:
    x = np.clip(e / q + 0.5, 0.0, 1.0)
    return x * x * (3.0 - 2.0 * x)
