"""What the rivals have in common: the Jacobian of the whole body, and from its rates to a plan."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin

from overreach.arm.chain import Chain
from overreach.arm.mount import Mount
from overreach.law.body import NO_SOLUTION
from overreach.types import HandTwist, Plan, Split

UNSOLVED = Plan(NO_SOLUTION)
"""What a rival plans whose solver failed: nothing, and why."""

Rows = tuple[tuple[float, ...], ...]


def commanded(u: HandTwist) -> tuple[float, ...]:
    """Return the six components of what is commanded, in the order of the rows of a Jacobian."""
    return u.u_r, u.u_t, u.u_z, u.w_r, u.w_t, u.w_z


def base_rows(chain: Chain, mount: Mount) -> Rows:
    """Return what the base's v_b and w_b do to the hand: six rows in polar axes [m/s, rad/s], two columns."""
    psi_d = chain.psi + mount.yaw
    c, sn = cos(psi_d), sin(psi_d)
    k_r = mount.s_x * sn - mount.s_y * c
    k_t = chain.l + mount.s_x * c + mount.s_y * sn
    none = (0.0, 0.0)
    return (c, k_r), (-sn, k_t), none, none, none, (0.0, 1.0)


def part(base: float, whole: float) -> float:
    """Return base/whole held to [0, 1]: the base's share of a motion; 0 of no motion at all."""
    if whole == 0.0:
        return 0.0
    return max(0.0, min(1.0, base / whole))


def planned(rates: Sequence[float], chain: Chain, base: Rows, u_r: float) -> Plan:
    """Return base and joint rates as a plan, with the arm's polar rates and the shares read off them.

    mu = (c v_b + k_r w_b)/u_r, the base's part of the radial motion, sigma = w_b/(w_b + w_m), both held to [0, 1].
    """
    v_b, w_b, *joints = rates
    radial = base[0][0] * v_b + base[0][1] * w_b
    own = tuple(joints)
    v_m, w_m, *_ = chain.moved(own)
    return Plan(Split(part(radial, u_r), part(w_b, w_b + w_m), v_b, w_b, v_m, w_m), own)
