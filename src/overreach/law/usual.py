"""The law that suits a robot, if none is asked for."""

from __future__ import annotations

from overreach.arm.chain import is_aside
from overreach.law.laws import Exact, Law, usual_blend
from overreach.law.side import Side
from overreach.model.model import Model


def usual_law(model: Model) -> Law:
    """Return `exact` or, for an arm that cannot move its hand about the shoulder, `side`, with the robot's bands."""
    if is_aside(model.arm):
        return Side(usual_blend(Side().blend, model))
    return Exact(usual_blend(Exact().blend, model))
