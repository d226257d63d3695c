"""The law for arms that cannot move their hand about the shoulder, such as a telescope to the side: `side`.

What lies along the base's way is the drive's, at once and whole; what lies across it is the arm's. Before the arm ends,
the base swings until its way is the hand's.
"""

from __future__ import annotations

from math import atan2, copysign, cos, hypot, pi, sin
from typing import Annotated

from overreach.arm.chain import Chain, turns_by_itself
from overreach.law.authority import Mount3, Shares
from overreach.law.blend import Blend, Rise, Smoothstep
from overreach.law.body import CarryingPlanner
from overreach.law.laws import Law, Share
from overreach.law.lead import lead
from overreach.law.recentre import CHOICES, OFF, SPARE, USUAL, Carried, Centring
from overreach.model.model import Model
from overreach.parameters import choice
from overreach.types import HandTwist, Plan, Split, Twist
from overreach.verdicts import Verdict

SURE = 1e-3
"""Where less than this part of the hand's motion is along the base's way, the base swings on as it does."""
STRAIGHT = 0.2
"""Sine of the least angle between the arm and the way of the base at which the hand keeps its whole speed.
The base goes 1/sine times as fast."""
STILL = 0.01
"""A base that turns slower than this [rad/s] does not swing."""
SWINGS = 0.6
"""The base swings in this part of a band; in the rest, at its end, the hand waits."""
ALONG = 0.25
"""Length [m] in which the way of the base closes in on that of the hand by 1/e, as it re-centres the arm."""
WITHIN = 1.0 - 1e-9
"""A base is asked for this part of its greatest speeds: no rounding is to pass them."""
NARROWEST = 0.01
"""A band is at least so wide [m]: a base cannot swing in none."""
Ends = tuple[float, float, float, float]
"""l_min, l_max: where the arm ends; d, q: how far before it the base swings, and then the hand waits [m]."""


def side(
    l: float,
    psi: float,
    u_r: float,
    u_t: float,
    rise: Rise,
    ends: Ends,
    mount: Mount3,
    most: float,
    sense: float = 0.0,
    w_c: float = 0.0,
    steer: float = 0.0,
    tops: tuple[float, float] | None = None,
) -> Shares:
    """Share between a drive along the base's x axis and an arm across it: (mu, sigma, v_b, w_b, v_m, w_m, scale).

    With psi_d = psi + yaw, c, sn its cosine and sine, k_r and k_t the levers of a base rotation as in `exact`, mu the
    rise over d before the arm's end at L = l_max - q (u_r >= 0; or l_min + q), f over the last q, and e = |u_r|/most:
        s   = (1 - f)/(1 - f + f e)                    the hand waits
        w_b = -sgn(u_t) (mu pi/d u_r + steer |u_t|) + s w_c
        v_b = (k_t w_b - s u_t)/sn                     the hand does not feel the swing
        v_m = s u_r - c v_b - k_r w_b,   w_m = 0
    A base whose turning centre the arm's line misses, by k_r, moves the arm's end by k_r a as it swings by a, the angle
    between the two ways: where that is outward, the arm's end counts as so much nearer.

    Straight on, any angle between the hand's way and the base's turns to 0 before L, at any speed: the base turns by
    pi/d times the integral of mu over d, a quarter of a turn.

    most: the hand's greatest speed [m/s]; sense: sgn(u_t), where u_t says nothing, 0 for the one in which the swing
    draws the arm in; w_c: turning [rad/s] that is commanded of the base; steer [rad/m]: turning to re-centre the arm;
    tops: greatest |v_b| [m/s] and |w_b| [rad/s], to which a swing is cut. Source: this project.
    """
    l_min, l_max, d, q = ends
    s_x, s_y, yaw = mount
    c, sn = cos(psi + yaw), sin(psi + yaw)
    k_r, k_t = s_x * sn - s_y * c, l + s_x * c + s_y * sn
    speed = hypot(u_r, u_t)
    if speed == 0.0 and w_c == 0.0:
        return 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0
    if abs(u_t) > SURE * speed:
        sense = copysign(1.0, u_t)
    elif sense == 0.0:
        sense = -copysign(1.0, k_r)
    if k_r * sense > 0.0:
        shorter = abs(k_r) * atan2(abs(u_r), abs(u_t))
        l_min, l_max = l_min + shorter, l_max - shorter
    if u_r >= 0.0:
        mu, wait = rise(l - l_max + q + 0.5 * d, d), rise(l - l_max + 0.5 * q, q)
    else:
        mu, wait = rise(l_min + q + 0.5 * d - l, d), rise(l_min + 0.5 * q - l, q)
    across, left = abs(u_r) / most, 1.0 - wait
    scale = left / (left + wait * across) if across > 0.0 else 1.0  # continuous where u_r turns round
    along = scale * u_t
    w_b = scale * w_c - sense * (mu * pi / d * u_r + steer * abs(u_t))
    if tops is not None:
        w_b = _within(w_b, along, k_t, sn, *tops)
    drive = k_t * w_b - along
    if abs(sn) < STRAIGHT:
        v_b, less = _oblique(drive, sn)
        w_b, scale = less * w_b, less * scale
        along = scale * u_t
    else:
        v_b = drive / sn
    return mu, 1.0, v_b, w_b, scale * u_r - c * v_b - k_r * w_b, (along + sn * v_b - k_t * w_b) / l, scale


def _oblique(drive: float, sn: float) -> tuple[float, float]:
    """Return v_b and the part of the command that is left where the drive hardly moves the hand across the arm."""
    less = (sn / STRAIGHT) ** 2
    return copysign(abs(drive) / STRAIGHT * abs(sn) / STRAIGHT, drive * sn), less


def _within(w_b: float, along: float, k_t: float, sn: float, v_max: float, w_max: float) -> float:
    """Return w_b [rad/s] cut to what the base can turn at, and drive along with at v_max [m/s].

    Also once the hand is let go: else the drive could no longer hold it while the turning comes to rest. Where `along`
    alone is beyond v_max, the turning is not cut for it: the whole command has to be scaled.
    """
    if k_t <= 0.0:
        return max(-w_max, min(w_max, w_b))
    room = v_max * abs(sn)
    most = min(w_max, room / k_t)
    w_b = max(-most, min(most, w_b))
    return w_b if abs(along) >= room else max((along - room) / k_t, min((along + room) / k_t, w_b))


class Alongside(Centring, frozen=True):
    """Re-centring by steering, bound to a robot: the base comes nearer to the hand's line, or goes off it.

    middle: mid-reach [m]; most: greatest turning [rad/m].
    """

    middle: float
    most: float

    def along(self, u: HandTwist) -> float:
        """The drive carries all of u_t."""
        return u.u_t

    def after(self, now: Carried, mu: float, along: float, dt: float) -> Carried:
        """See `Centring`: the drive has all of it, whatever mu is."""
        return super().after(now, 1.0, along, dt)

    def steer(self, l: float, u_r: float, u_t: float) -> float:
        """Return 2 a/ALONG + (l - middle)/ALONG^2 [rad/m], within `most`; a: the angle between the two ways.

        On a straight line l and a go to middle and 0 with the double eigenvalue -1/ALONG, by metres driven.
        """
        turning = 2.0 * atan2(u_r, abs(u_t)) / ALONG + (l - self.middle) / ALONG**2
        return max(-self.most, min(self.most, turning))


class Side(Law, frozen=True):
    """Ours, for arms that cannot move their hand about the shoulder: the drive takes what lies along the base's way.

    Exact in true kinematics; before the arm ends, the base swings round behind the hand. recentre: whether the arm
    comes back to mid-reach while the base carries the hand.
    """

    name = "side"
    aside = True
    blend: Blend = Smoothstep()
    recentre: Annotated[str, choice("Re-centring", CHOICES)] = USUAL

    def bind(self, model: Model) -> Share:
        """Return `side` for `model`, for a hand that only goes, and a base whose limits are not looked at."""
        rise, ends, mount, most = self.blend.rise, self.ends(model), model.mount.three, model.command.v_c
        return lambda l, psi, u_r, u_t: Split(*side(l, psi, u_r, u_t, rise, ends, mount, most))

    def ends(self, model: Model) -> Ends:
        """Return where the arm ends, and the lengths in which the base swings and the hand waits [m]."""
        space = model.workspace
        blend = self.blend.narrowed(*space.widest) if space.edges else self.blend
        band = max(blend.width_l, NARROWEST)
        return space.l_min, space.l_max, SWINGS * band, (1.0 - SWINGS) * band

    def recentring(self, model: Model) -> Alongside | None:
        """Return how the arm is brought back to mid-reach."""
        space, base = model.workspace, model.base
        if self.recentre == OFF or (self.recentre == USUAL and not space.edges):
            return None
        most = (SPARE * base.v_max / model.command.v_c - 1.0) / space.l_max
        half = 0.5 * (space.l_max - space.l_min)
        return Alongside(half, space.l_min + half, most) if most > 0.0 else None

    def planner(self, model: Model) -> CarryingPlanner:
        """As of any law; with the turning that is commanded of a hand that turns with the base, within base limits."""
        rise, ends, mount, base = self.blend.rise, self.ends(model), model.mount.three, model.base
        centring, tops, lag = self.recentring(model), (WITHIN * base.v_max, WITHIN * base.w_max), base.lag
        with_base, most = not turns_by_itself(model.arm), model.command.v_c

        def plan(chain: Chain, u: HandTwist, is_: Twist, carried: float = 0.0) -> Plan:
            l, psi, u_r, u_t = chain.l, chain.psi, u.u_r, u.u_t
            if lag > 0.0:
                l, psi, u_r, u_t = lead(l, psi, u_r, u_t, is_.v_x, is_.w_z, lag, mount)
            sense = -copysign(1.0, is_.w_z * u_r) if abs(is_.w_z) > STILL else 0.0
            steer = carried * centring.steer(l, u_r, u_t) if carried and centring else 0.0
            w_c = u.w_z if with_base else 0.0
            shares = side(l, psi, u_r, u_t, rise, ends, mount, most, sense, w_c, steer, tops)
            waits = shares[0] > 0.0 and shares[-1] < 1.0
            return Plan(Split(*shares, Verdict.SWINGING if waits else Verdict.MOVING))

        return plan
