"""Who moves the hand: the Protocol of everything that plans for the whole body, sharing laws and their rivals alike."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import ClassVar

from overreach.arm.chain import Chain
from overreach.errors import LONGEST_NAME
from overreach.model.model import Model
from overreach.parameters import Parameters
from overreach.types import FLOATS, Frame, HandTwist, Plan, Split, Twist
from overreach.verdicts import Verdict

Planner = Callable[[Chain, HandTwist, Twist], Plan]
"""(arm at its joints, what is commanded, the base's motion as it is) -> plan. Pure; raises nothing."""


class WholeBody(Parameters, frozen=True):
    """Plans the rates of base and arm for one EE velocity: frozen parameters, which meet a robot in `planner`."""

    frame: ClassVar[Frame] = Frame.HAND
    """The command frame that suits it, used unless another is asked for."""
    closes_residual: ClassVar[bool] = True
    """Whether the arm is to make up for what the base does otherwise than asked (lag, slip, limits)."""

    slow_to_load: ClassVar[bool] = False
    """Whether the first of its kind brings libraries along for a while: such a law is first chosen at rest."""

    def planner(self, model: Model) -> Planner:
        """Return what plans for `model`."""
        raise NotImplementedError


class UnusableError(ValueError):
    """A plan that cannot be used; says which part is what."""


ANSWERS = (Verdict.MOVING, Verdict.NO_SOLUTION)
"""What a law may say of its answer; the other verdicts are not a law's to give."""
NO_SOLUTION = Split(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, Verdict.NO_SOLUTION)
"""What is given where a solver failed: zero, and why."""


def checked(plan: Plan) -> Plan:
    """Return a plan as plain floats.

    Raises UnusableError unless every number is finite, the scale in [0, 1] and the verdict one that a law may give.
    """
    split = plan.split
    numbers = (split.mu, split.sigma, split.v_b, split.w_b, split.v_m, split.w_m, split.scale, *(plan.joints or ()))
    if not (math.isfinite(sum(map(abs, numbers))) and 0.0 <= split.scale <= 1.0):
        for name in ("mu", "sigma", "scale", "v_b", "w_b", "v_m", "w_m"):
            value = getattr(split, name)
            if not math.isfinite(value) or (name == "scale" and not 0.0 <= value <= 1.0):
                raise UnusableError(f"{name} = {value}")
        raise UnusableError("rates too great to use")
    if split.verdict not in ANSWERS:
        raise UnusableError(f"the verdict {str(split.verdict)[:LONGEST_NAME]!r}")
    if set(map(type, numbers)) == FLOATS:
        return plan
    mu, sigma, v_b, w_b, v_m, w_m, scale, *joints = map(float, numbers)
    made = Split(mu, sigma, v_b, w_b, v_m, w_m, scale, split.verdict)
    return Plan(made, None if plan.joints is None else tuple(joints))
