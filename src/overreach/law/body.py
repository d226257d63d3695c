"""Who moves the hand: the base class of all that plan for the whole body, sharing laws and their rivals alike."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import ClassVar, Protocol

from overreach.arm.chain import Chain, is_aside
from overreach.errors import LONGEST_NAME, SetupError
from overreach.law.recentre import Centring
from overreach.model.model import Model
from overreach.parameters import Parameters
from overreach.types import FLOATS, Frame, HandTwist, Plan, Split, Twist
from overreach.verdicts import Verdict

ASIDE = "such as a telescope to the side"
Planner = Callable[[Chain, HandTwist, Twist], Plan]
"""(arm at its joints, commanded hand twist, measured base twist) -> plan. Pure; raises nothing."""


class CarryingPlanner(Protocol):
    """A planner of a law that re-centres the arm, which is also told how far the base has come to carry the hand."""

    def __call__(self, chain: Chain, u: HandTwist, base: Twist, carried: float = 0.0, /) -> Plan:
        """Return the plan. carried: 0 to 1, as in `overreach.law.recentre`."""
        ...


class WholeBody(Parameters, frozen=True):
    """Plans the rates of base and arm for one EE velocity: frozen parameters, bound to a robot by `planner`."""

    frame: ClassVar[Frame] = Frame.HAND
    """The command frame that suits it, used unless another is asked for."""
    closes_residual: ClassVar[bool] = True
    """Whether the arm is to make up for how the base deviates from what it was asked for (lag, slip, limits)."""

    aside: ClassVar[bool] = False
    """Whether it is for arms that cannot move their hand about the shoulder (`Arm.aside`), and for no others."""

    slow_to_load: ClassVar[bool] = False
    """Whether its first use spends a while importing libraries: such a law can first be chosen only at rest."""

    def planner(self, model: Model) -> Planner:
        """Return the planner for `model`."""
        raise NotImplementedError

    def recentring(self, model: Model) -> Centring | None:
        """Return how the arm is brought back to mid-reach while the base carries the hand; None: it is not.

        A law for which it is returns a `CarryingPlanner`.
        """
        return None


def check_fits(law: type[WholeBody] | WholeBody, model: Model) -> None:
    """Raise SetupError, with the reason, unless `law` is for arms such as that of `model`."""
    its = is_aside(model.arm)
    if its and not law.aside:
        raise SetupError(
            f"the law {law.name!r} needs an arm that moves its hand about the shoulder, and that of {model.name} "
            f"cannot ({ASIDE}): the law 'side' is for it"
        )
    if law.aside and not its:
        raise SetupError(
            f"the law {law.name!r} is for arms that cannot move their hand about the shoulder ({ASIDE}), and that of "
            f"{model.name} can: the law 'exact' is for it"
        )


class UnusableError(ValueError):
    """A plan that cannot be used; the text gives the part and its value."""


MAY_SAY = (Verdict.MOVING, Verdict.SWINGING, Verdict.NO_SOLUTION)
"""What a law may say of its answer: the other verdicts are not a law's to give."""
NO_SOLUTION = Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, Verdict.NO_SOLUTION)
"""The split to give when a solver fails: zero, and why."""


def checked(plan: Plan) -> Plan:
    """Return a plan as plain floats.

    Raises UnusableError unless every number is finite, the scale is in [0, 1] and a law may give the verdict.
    """
    split = plan.split
    own = () if plan.joints is None else tuple(plan.joints)
    aside = () if split.v_y is None else (split.v_y,)
    numbers = (split.mu, split.sigma, split.v_b, split.w_b, split.v_m, split.w_m, split.scale, *aside, *own)
    if not (math.isfinite(sum(map(abs, numbers))) and 0.0 <= split.scale <= 1.0):
        for name in ("mu", "sigma", "scale", "v_b", "w_b", "v_m", "w_m", *(("v_y",) if aside else ())):
            value = getattr(split, name)
            if not math.isfinite(value) or (name == "scale" and not 0.0 <= value <= 1.0):
                raise UnusableError(f"{name} = {value}")
        raise UnusableError("rates too great to use")
    if not any(split.verdict is one for one in MAY_SAY):  # a text that is equal is not it
        raise UnusableError(f"the verdict {str(split.verdict)[:LONGEST_NAME]!r}")
    if set(map(type, numbers)) == FLOATS and (plan.joints is None or own is plan.joints):
        return plan
    mu, sigma, v_b, w_b, v_m, w_m, scale, *joints = map(float, numbers)
    v_y = joints.pop(0) if aside else None
    made = Split(mu, sigma, v_b, w_b, v_m, w_m, scale, split.verdict, v_y)
    return Plan(made, None if plan.joints is None else tuple(joints))
