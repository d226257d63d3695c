"""The sharing laws as plugs: what a law is, and `Exact`, `Paper` and `Switch`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

from overreach.arm.chain import Chain
from overreach.law import authority
from overreach.law.blend import Blend, Smoothstep, Step, Tanh
from overreach.law.body import CarryingPlanner, Planner, WholeBody
from overreach.law.lead import lead
from overreach.law.recentre import CHOICES, USUAL, Recentring, recentring
from overreach.model.model import Model
from overreach.parameters import choice
from overreach.types import Frame, HandTwist, Plan, Split, Twist

Share = Callable[[float, float, float, float], Split]
"""(l [m], psi [rad], u_r, u_t [m/s]) -> shares of the EE's velocity, by base and arm. Pure; raises nothing; every
number is finite for finite input with l > 0."""


class Law(WholeBody, frozen=True):
    """Shares one planar EE velocity between base and arm: frozen parameters, bound to a robot by `bind`.

    A law of your own sets `name`, `frame` and `closes_residual`, and defines `bind`.
    """

    def bind(self, model: Model) -> Share:
        """Return the law for the workspace and mount of `model`."""
        raise NotImplementedError

    def planner(self, model: Model) -> Planner:
        """Return a planner that leaves the joint rates to the arm; if the base states a lag, shares are taken ahead."""
        share = self.bind(model)
        lag, mount = model.base.lag, model.mount.three

        def plan(chain: Chain, u: HandTwist, _base: Twist) -> Plan:
            return Plan(share(chain.l, chain.psi, u.u_r, u.u_t))

        def plan_ahead(chain: Chain, u: HandTwist, base: Twist) -> Plan:
            ahead = lead(chain.l, chain.psi, u.u_r, u.u_t, base.v_x, base.w_z, lag, mount, base.v_y)
            return Plan(share(*ahead))

        return plan_ahead if lag > 0.0 and self.closes_residual else plan


def constants(model: Model, blend: Blend) -> tuple[authority.Limits6, authority.Mount3]:
    """Return the numbers that the functions in `authority` take."""
    space = model.workspace
    if space.edges:
        blend = blend.narrowed(*space.widest)
    return (*space.middles(blend.width_l, blend.width_psi), blend.k_l, blend.k_psi), model.mount.three


def usual_blend(blend: Blend, model: Model) -> Blend:
    """Return a blend with the widths that suit a robot, where its workspace is given by outer edges."""
    if not model.workspace.edges:
        return blend
    width_l, width_psi, _ = model.bands
    return blend.fitted(width_l, width_psi)


def bound(shares: Callable[..., authority.Shares], model: Model, blend: Blend) -> Share:
    """Return one of the functions in `authority` with its blend, limits and mount filled in."""
    rise = blend.rise
    limits, mount = constants(model, blend)

    def share(l: float, psi: float, u_r: float, u_t: float) -> Split:
        return Split(*shares(l, psi, u_r, u_t, rise, limits, mount))

    return share


class Exact(Law, frozen=True):
    """Ours: exact in true kinematics, the arm closes what the base leaves, the base lines up.

    A base that moves sideways too needs not line up: it carries its share of the command itself. recentre: whether the
    arm comes back to mid-reach while the base carries the hand.
    """

    name = "exact"
    blend: Blend = Smoothstep()
    recentre: Annotated[str, choice("Re-centring", CHOICES)] = USUAL

    def bind(self, model: Model) -> Share:
        """Return `authority.exact` for `model`; of `authority.omni`, where the base is omni, for a hand that only goes.

        `planner` gives the base its part of the turning as well.
        """
        if not model.base.omni:
            return bound(authority.exact, model, self.blend)
        share = self._share(model)
        return lambda l, psi, u_r, u_t: share(l, psi, u_r, u_t, 0.0, 0.0, 0.0)

    def recentring(self, model: Model) -> Recentring | None:
        """Return how the arm is brought back to mid-reach."""
        return recentring(model, self.recentre)

    def _share(self, model: Model) -> Callable[[float, float, float, float, float, float, float], Split]:
        """Return the shares for (l, psi, u_r, u_t, w_c, carried, lead)."""
        rise = self.blend.rise
        limits, mount = constants(model, self.blend)

        def sideways(l: float, psi: float, u_r: float, u_t: float, w_c: float, k: float, lead: float) -> Split:
            mu, sigma, v_x, v_y, w_b, v_m, w_m = authority.omni(l, psi, u_r, u_t, w_c, rise, limits, mount, k, lead)
            return Split(mu, sigma, v_x, w_b, v_m, w_m, v_y=v_y)

        def share(l: float, psi: float, u_r: float, u_t: float, _w_c: float, k: float, lead: float) -> Split:
            return Split(*authority.exact(l, psi, u_r, u_t, rise, limits, mount, k, lead))

        return sideways if model.base.omni else share

    def planner(self, model: Model) -> CarryingPlanner:
        """As of any law; with the turning that is commanded, and with how far the base has come to carry the hand."""
        share, centring = self._share(model), self.recentring(model)
        lag, mount = model.base.lag, model.mount.three

        def plan(chain: Chain, u: HandTwist, base: Twist, carried: float = 0.0) -> Plan:
            l, psi, u_r, u_t = chain.l, chain.psi, u.u_r, u.u_t
            if lag > 0.0:
                l, psi, u_r, u_t = lead(l, psi, u_r, u_t, base.v_x, base.w_z, lag, mount, base.v_y)
            more = centring.lead(l, 1.0 if u_r >= 0.0 else -1.0) if carried and centring else 0.0
            return Plan(share(l, psi, u_r, u_t, u.w_z, carried, more))

        return plan


class Paper(Law, frozen=True):
    """Kwon et al. 2026, (14) to (16), to the letter: distorts the hand's motion by mu |v_c tan psi|."""

    name = "paper"
    frame = Frame.POLAR
    closes_residual = False
    blend: Blend = Tanh()

    def bind(self, model: Model) -> Share:
        """Return `authority.paper` for `model`."""
        return bound(authority.paper, model, self.blend)


class Switch(Law, frozen=True):
    """Kwon et al. 2026 without blending, (12) and (13): the hard switch."""

    name = "switch"
    frame = Frame.POLAR
    closes_residual = False

    def bind(self, model: Model) -> Share:
        """Return `authority.paper` with a step for `model`."""
        return bound(authority.paper, model, Step())
