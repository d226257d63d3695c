"""What everything that plans for the whole body must satisfy. In a test: `check_whole_body(MyBody(), my_model())`."""

from __future__ import annotations

import math
import random

from overreach.arm.chain import Chain
from overreach.law.authority import ee_velocity
from overreach.law.body import WholeBody, checked
from overreach.model.model import Model
from overreach.types import HandTwist, Plan, Twist
from overreach.verdicts import Verdict

RATES = ("v_b", "v_y", "w_b", "v_m", "w_m")
SAME = 1e-9
"""How closely [m/s, rad/s] the polar rates of a plan must match those of its joint rates ..."""
EXACT_TO = 1e-9
"""... and the hand's velocity its command, if the whole body says that it closes the residual."""
SPEED = 0.4
"""Commands go up to this speed [m/s, rad/s]."""


def check_whole_body(body: WholeBody, model: Model, seed: int = 0, cases: int = 300) -> None:
    """Raise AssertionError, with the case, where `body` breaks a promise; `cases` random states of `model`.

    Checked: it has all that `WholeBody` names; every plan is finite, with shares and scale in [0, 1], wherever the arm
    can be and whatever the base does; a zero command gives no motion; a plan's polar rates are those of its joint
    rates; the same question gives the same answer, whatever was asked in between; no solution means zero; and if it
    says that it closes the residual, the hand moves as commanded, times the scale.
    """
    missing = [name for name in ("name", "frame", "closes_residual", "planner") if not hasattr(body, name)]
    assert not missing, f"whole body lacks {', '.join(missing)}"
    plan, chance = body.planner(model), random.Random(seed)
    first: list[tuple[Chain, HandTwist, Twist, Plan]] = []
    for _ in range(cases):
        least, most = model.arm.reach
        space = model.workspace
        l = chance.uniform(max(least, 0.9 * space.l_min), min(most, 1.1 * space.l_max))
        chain = model.arm.at(model.arm.posture(l, chance.uniform(space.psi_min, space.psi_max)), model.mount)
        u = _command(chance, model)
        base = Twist(chance.uniform(-SPEED, SPEED), w_z=chance.uniform(-SPEED, SPEED))
        made = plan(chain, u, base)
        _check_plan(made, chain, u)
        if body.closes_residual:
            _check_exact(model, made, chain, u)
        rest = plan(chain, HandTwist(), base)
        still = not any(getattr(rest.split, rate) for rate in RATES) and not any(rest.joints or ())
        assert still, f"moves without a command at {chain.joints}: {rest}"
        if len(first) < 20:
            first.append((chain, u, base, made))
    for chain, u, base, made in first:
        again = plan(chain, u, base)
        assert again == made, f"not a pure function: at {chain.joints} first {made}, later {again}"


def _command(chance: random.Random, model: Model) -> HandTwist:
    """Return a random command in the rows that the arm has."""
    return HandTwist(*[chance.uniform(-SPEED, SPEED) if k in model.arm.rows else 0.0 for k in range(6)])


def _check_plan(plan: Plan, chain: Chain, u: HandTwist) -> None:
    where = f"at {chain.joints} for {u}"
    split = plan.split
    try:
        checked(plan)
    except ValueError as error:
        raise AssertionError(f"cannot be used {where}: {error}") from None
    for share in ("mu", "sigma"):
        assert 0.0 <= getattr(split, share) <= 1.0, f"{share} is not in [0, 1] {where}: {plan}"
    if split.verdict is not Verdict.MOVING:
        still = not any(getattr(split, rate) for rate in RATES) and not any(plan.joints or ())
        assert still, f"{split.verdict} but not still {where}: {plan}"
        assert split.scale == 0.0, f"{split.verdict} but scale is not 0 {where}: {plan}"
    if plan.joints is not None:
        v_m, w_m, *_ = chain.moved(plan.joints)
        off = max(abs(v_m - split.v_m), abs(w_m - split.w_m))
        assert off <= SAME, f"polar rates are {off:.2g} off those of the joints {where}: {plan}"


def _check_exact(model: Model, plan: Plan, chain: Chain, u: HandTwist) -> None:
    split = plan.split
    rates = split.v_b, split.w_b, split.v_m, split.w_m
    got = ee_velocity(chain.l, chain.psi, *rates, model.mount.three, split.v_y or 0.0)
    off = math.hypot(got[0] - split.scale * u.u_r, got[1] - split.scale * u.u_t)
    assert off <= EXACT_TO, f"the hand is {off:.2g} m/s off its command at {chain.joints} for {u}: {plan}"
