"""Limits and residual for an arm whose joint rates follow from the split: one scale for the whole command."""

from __future__ import annotations

from operator import add
from typing import final

from msgspec.structs import astuple

from overreach.arm.chain import NO_REST, Chain, Rest
from overreach.control.bounds import Bounds
from overreach.control.decision import Decision
from overreach.law.authority import arm_residual
from overreach.law.body import UnusableError
from overreach.model.model import Model
from overreach.types import BaseTwist, HandTwist, Plan, PolarState, RobotState, Split, Twist
from overreach.verdicts import Verdict

MOVING = Verdict.MOVING  # used a few times per tick: a module's name is faster to look up than an enum's member
NO_TWIST = Twist()


@final
class Solved:
    """Decides for one robot. Each period ends exactly at (l + v_m dt, psi + w_m dt)."""

    def __init__(self, model: Model, bounds: Bounds) -> None:
        self._bounds, self._base, self._mount = bounds, model.base, model.mount.three
        self._still = (0.0,) * len(model.arm.channels)
        self._beyond = any(row > 1 for row in model.arm.rows)
        self._lags = model.base.lag > 0.0

    def decide(
        self,
        chain: Chain,
        state: RobotState,
        polar: PolarState,
        u: HandTwist,
        plan: Plan,
        slip: Twist | None,
        dt: float,
    ) -> Decision:
        """Decide for a plan for `u`. slip: how the base deviates from what it is asked, None if the arm lets it."""
        split, own = plan.split, plan.joints
        if own is not None and len(own) != len(self._still):
            raise UnusableError(f"{len(own)} joint rates for {len(self._still)} joints")
        l, psi, mount, u_r, u_t = polar.l, polar.psi, self._mount, u.u_r, u.u_t
        base, bounds = self._base, self._bounds
        full, verdict = split.scale, split.verdict
        if verdict is MOVING and full < 1.0:
            verdict = Verdict.BESIDE
        v_b, v_y, w_b, v_m, w_m = split.v_b, split.v_y or 0.0, split.w_b, split.v_m, split.w_m

        # The base may not do what it was asked for: assume that it keeps deviating as it last did.
        closes = slip is not None
        is_ = slip or NO_TWIST
        slip_v, slip_y, slip_w = is_.v_x, is_.v_y, is_.w_z
        owed = self._still
        if closes and (slip_v != 0.0 or slip_y != 0.0 or slip_w != 0.0 or self._lags):
            real = v_b + slip_v, w_b + slip_w, mount, v_y + slip_y
            v_m, w_m = arm_residual(l, psi, u_r * full, u_t * full, *real)
            rest = (0.0, 0.0, 0.0, -slip_w)
            owed = chain.rates(*arm_residual(l, psi, 0.0, 0.0, slip_v, slip_w, mount, slip_y), rest, 0.0)[0]
        if own is None:
            joints, short = chain.rates(v_m, w_m, self._rest_of(u, full, w_b + slip_w), dt)
        else:
            joints, short = tuple(map(add, own, owed)), MOVING

        scale, free, changed = 1.0, None, False
        wanted = base.rates(BaseTwist(v_b, v_y, w_b))
        if not bounds.keep((*wanted, *joints), state.q, dt):
            free = bounds.room(state.q, dt)
            scale, why = bounds.scale((*wanted, *joints), owed, free)
            if why is not MOVING:
                verdict = why
            kept = bounds.base(tuple([rate * scale for rate in wanted]))
            changed = kept != wanted
            v_b, v_y, w_b = astuple(base.twist(kept))
        if scale != 1.0 or (closes and changed):
            if closes:
                k, real = full * scale, (v_b + slip_v, w_b + slip_w, mount, v_y + slip_y)
                v_m, w_m = arm_residual(l, psi, u_r * k, u_t * k, *real)
            else:
                v_m, w_m = v_m * scale, w_m * scale
            if own is None:
                joints, short = chain.rates(v_m, w_m, self._rest_of(u, full * scale, w_b + slip_w), dt)
            else:
                joints = tuple([rate * scale + more for rate, more in zip(own, owed, strict=True)])
        bounded = joints if free is None else bounds.joints(joints, free)
        if short is not MOVING:
            verdict = short
        if short is not MOVING or bounded != joints:
            joints = bounded
            v_m, w_m, *_ = chain.moved(joints)  # what these joint rates really do
        aside = v_y if base.omni else None
        applied = Split(split.mu, split.sigma, v_b, w_b, v_m, w_m, full * scale, split.verdict, aside)
        return Decision(state, polar, u, applied, joints, full * scale, verdict)

    def _rest_of(self, u: HandTwist, scale: float, w_b: float) -> Rest:
        """Return what the arm owes beyond the plane, with the base turning at w_b; all zero for an arm in the plane."""
        if not self._beyond:
            return NO_REST
        return u.u_z * scale, u.w_r * scale, u.w_t * scale, u.w_z * scale - w_b
