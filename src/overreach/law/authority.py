"""The sharing laws as pure functions of floats: `paper` (and with a step blend `switch`), `exact`, `omni`.

Each takes the EE's position about the shoulder (l [m], psi [rad], from the arm's x axis), its
commanded velocity in polar components in the base frame (u_r outward, u_t counter-clockwise
[m/s]), the blend's `rise`, limits = (l_min, l_max, psi_min, psi_max, k_l, k_psi) and
mount = (s_x, s_y, yaw), and returns (mu, sigma, v_b, w_b, v_m, w_m, scale), as in
`overreach.types.Split`. Both are homogeneous: a scaled command gives scaled rates.
"""

from __future__ import annotations

from math import atan, copysign, cos, hypot, pi, sin, sqrt

from overreach.law.blend import Rise

Limits6 = tuple[float, float, float, float, float, float]
Mount3 = tuple[float, float, float]
Shares = tuple[float, float, float, float, float, float, float]

BASE_GAIN = 5.0
"""The base drives at most this many times as fast as the hand; nearer to c = 0 the whole command is scaled."""

BASE_GAIN_2 = BASE_GAIN * BASE_GAIN

LEVER_MIN = 0.1
"""The lever k_t, with which a base rotation moves the hand, is taken as at least this fraction of l."""
LEVER_MIN_2 = LEVER_MIN * LEVER_MIN

HUGE = 1e300
"""(|u|/u_r)^2 above which the base has practically nothing to drive, and nothing to line up with."""


def scaled_drive(drive: float, lined: float, speed: float) -> tuple[float, float]:
    """Return (v_b [m/s], scale) where v_b = drive / lined would pass BASE_GAIN times the hand's speed.

    There the hand is beside the base and driving hardly moves it radially. The whole command is
    scaled by (bound / |v_b|)^2, so that v_b goes to 0, not to infinity, as `lined` does.
    """
    ratio = BASE_GAIN * speed * abs(lined) / abs(drive)
    return copysign(BASE_GAIN * speed * ratio, drive * lined), ratio * ratio


def paper(
    l: float,
    psi: float,
    u_r: float,
    u_t: float,
    rise: Rise,
    limits: Limits6,
    mount: Mount3,
) -> Shares:
    """Share as the paper does, with v_c = u_r and w_c = u_t / l.

    v_bm = mu v_c, v_m = (1 - mu) v_c, v_b = v_bm / cos psi, w_b = sigma w_c, w_m = (1 - sigma) w_c.
    In true kinematics the EE deviates from the command by mu |v_c tan psi|. Source: Kwon et al. 2026, (12) to (16).
    """
    l_min, l_max, psi_min, psi_max, k_l, k_psi = limits
    w_c = u_t / l
    mu = rise(l - l_max, k_l) if u_r >= 0.0 else rise(l_min - l, k_l)
    sigma = rise(psi - psi_max, k_psi) if w_c >= 0.0 else rise(psi_min - psi, k_psi)
    drive = mu * u_r
    c = cos(psi + mount[2])
    scale = 1.0
    if drive * drive > BASE_GAIN_2 * (u_r * u_r + u_t * u_t) * c * c:
        v_b, scale = scaled_drive(drive, c, hypot(u_r, u_t))
        u_r *= scale
        w_c *= scale
    else:
        v_b = drive / c
    return mu, sigma, v_b, sigma * w_c, (1.0 - mu) * u_r, (1.0 - sigma) * w_c, scale


def exact(
    l: float,
    psi: float,
    u_r: float,
    u_t: float,
    rise: Rise,
    limits: Limits6,
    mount: Mount3,
    carried: float = 0.0,
    lead: float = 0.0,
) -> Shares:
    """Share so that the EE does exactly what is commanded: the arm closes the residual.

    With c = cos psi_d, sn = sin psi_d, psi_d = psi + yaw, and the levers k_r = s_x sn - s_y c,
    k_t = l + s_x c + s_y sn of a base rotation:
        w_l = q mu u_r / c                                       the base lines up while it drives
        v_b = (mu u_r - (1 - sigma) w_l k_r - sigma u_t k_r/k_t) / (c + sigma sn k_r/k_t)
        w_b = sigma (u_t + v_b sn)/k_t + (1 - sigma) w_l
        v_m = u_r - c v_b - k_r w_b,   w_m = (u_t + sn v_b - k_t w_b)/l
    q [rad/m] is the turn per metre that brings the base behind the hand's line of motion. carried, lead: as in
    `overreach.law.recentre`: the part of mu that is 1 + lead instead.
    Source: this project (docs/why.md), with the shares of Kwon et al. 2026.
    """
    l_min, l_max, psi_min, psi_max, k_l, k_psi = limits
    s_x, s_y, yaw = mount
    psi_d = psi + yaw
    c = cos(psi_d)
    sn = sin(psi_d)
    k_r = s_x * sn - s_y * c
    k_t = l + s_x * c + s_y * sn

    if u_r >= 0.0:
        g = 1.0
        mu = rise(l - l_max, k_l)
    else:
        g = -1.0
        mu = rise(l_min - l, k_l)
    if carried != 0.0:
        mu += carried * (1.0 + lead - mu)
    drive = mu * u_r
    scale = 1.0
    v_b = 0.0
    w_l = 0.0
    if drive != 0.0:
        t = u_t / u_r
        one = 1.0 + t * t
        if mu * mu > BASE_GAIN_2 * one * c * c:
            v_b, scale = scaled_drive(drive, c, hypot(u_r, u_t))
        else:
            v_b = drive / c
        if one < HUGE:
            # Line up behind the hand. eta is the heading, from the base's, of the hand's line of motion (of u
            # if u_r >= 0, else of -u), y = g (k_t u_t + k_r u_r)/|u| the base's offset to the left of it and
            # L^2 = k_t^2 + k_r^2 the hand's distance: q = -y/L^2 + 2 g eta/L. Deviations die out with the double
            # eigenvalue -|v_b|/l, driving and reversing alike.
            eta = psi_d + atan(t)
            if eta > pi or eta < -pi:
                eta -= copysign(2.0 * pi, eta)
            if k_r == 0.0 and k_t >= l:
                w_l = v_b * (2.0 * g * eta - t / sqrt(one)) / k_t
            else:
                length_2 = max(k_t * k_t + k_r * k_r, LEVER_MIN_2 * l * l)
                w_l = v_b * (2.0 * g * eta * sqrt(length_2) - (k_t * t + k_r) / sqrt(one)) / length_2

    # sigma depends on the sign of w_des, the bearing rate that is left to the arm if the base only drives and
    # lines up. That sign is the same for every sigma wherever driving helps at all, so no search is needed.
    w_des = u_t * scale - k_t * w_l + v_b * sn
    if k_r != 0.0:
        w_des -= k_r * sn / c * w_l
    sigma = rise(psi - psi_max, k_psi) if w_des >= 0.0 else rise(psi_min - psi, k_psi)
    lever = k_t
    if k_r != 0.0:
        lever = max(k_t, LEVER_MIN * l)
        ratio = sigma * k_r / lever
        drive = v_b * c - (1.0 - sigma) * w_l * k_r - u_t * scale * ratio
        straight = c + sn * ratio
        if drive * drive > BASE_GAIN_2 * (u_r * u_r + u_t * u_t) * straight * straight:
            v_b, more = scaled_drive(drive, straight, hypot(u_r, u_t))
            scale *= more
            w_l *= more
        elif straight != 0.0:
            v_b = drive / straight
    if scale != 1.0:
        u_r *= scale
        u_t *= scale
    d = u_t + v_b * sn
    w_b = sigma * d / lever + (1.0 - sigma) * w_l
    mu = min(mu, 1.0)
    return mu, sigma, v_b, w_b, u_r - c * v_b - k_r * w_b, (d - k_t * w_b) / l, scale


def omni(
    l: float,
    psi: float,
    u_r: float,
    u_t: float,
    w_c: float,
    rise: Rise,
    limits: Limits6,
    mount: Mount3,
    carried: float = 0.0,
    lead: float = 0.0,
) -> tuple[float, float, float, float, float, float, float]:
    """Share with a base that moves sideways too: its part of the motion is the part that is commanded, itself.

    Return (mu, sigma, v_x, v_y, w_b, v_m, w_m), for a command that turns the hand at w_c [rad/s]:
        w_b = sigma w_c,   (v_x, v_y) + w_b z x p = mu u_r r + sigma u_t t
        v_m = (1 - mu) u_r,   w_m = (1 - sigma) u_t/l
    with p the hand in the base frame; carried, lead: as in `exact`. Bands are kept exactly, and the whole command is
    carried out.
    Source: this project, with the shares of Kwon et al. 2026.
    """
    l_min, l_max, psi_min, psi_max, k_l, k_psi = limits
    s_x, s_y, yaw = mount
    c = cos(psi + yaw)
    sn = sin(psi + yaw)
    mu = rise(l - l_max, k_l) if u_r >= 0.0 else rise(l_min - l, k_l)
    sigma = rise(psi - psi_max, k_psi) if u_t >= 0.0 else rise(psi_min - psi, k_psi)
    if carried != 0.0:
        mu += carried * (1.0 + lead - mu)
    out = mu * u_r
    along = sigma * u_t
    w_b = sigma * w_c
    v_x = out * c - along * sn + w_b * (s_y + l * sn)
    v_y = out * sn + along * c - w_b * (s_x + l * c)
    return min(1.0, mu), sigma, v_x, v_y, w_b, (1.0 - mu) * u_r, (1.0 - sigma) * u_t / l


def ee_velocity(
    l: float,
    psi: float,
    v_b: float,
    w_b: float,
    v_m: float,
    w_m: float,
    mount: Mount3,
    v_y: float = 0.0,
) -> tuple[float, float]:
    """Return the EE's true rigid-body velocity (radial, tangential) [m/s], in the base frame's axes.

    u_r = v_b cos psi_d + v_y sin psi_d + w_b k_r + v_m,   u_t = -v_b sin psi_d + v_y cos psi_d + w_b k_t + l w_m
    """
    s_x, s_y, yaw = mount
    c = cos(psi + yaw)
    sn = sin(psi + yaw)
    return (
        v_b * c + v_y * sn + w_b * (s_x * sn - s_y * c) + v_m,
        -v_b * sn + v_y * c + w_b * (l + s_x * c + s_y * sn) + l * w_m,
    )


def arm_residual(
    l: float,
    psi: float,
    u_r: float,
    u_t: float,
    v_b: float,
    w_b: float,
    mount: Mount3,
    v_y: float = 0.0,
) -> tuple[float, float]:
    """Return (v_m [m/s], w_m [rad/s]): what the arm must do so that the EE moves at (u_r, u_t).

    (v_b, w_b), and v_y to its left, is the base twist that is really happening: the base may lag, slip or be limited.
    """
    b_r, b_t = ee_velocity(l, psi, v_b, w_b, 0.0, 0.0, mount, v_y)
    return u_r - b_r, (u_t - b_t) / l
