"""What of a robot's report can be believed."""

from __future__ import annotations

from math import isfinite

from msgspec.structs import astuple

from overreach.gate.feedback import Feedback
from overreach.types import FLOATS, RobotState

UNIT = 0.01
"""How far the square of an attitude's quaternion may be from 1."""


def reported(state: RobotState, feedback: Feedback, omni: bool, now: float) -> tuple[RobotState, str]:
    """Return a reported state as plain floats, and what is wrong with it, as a sentence, or "".

    omni: whether the base moves sideways too. May raise what a plug-in driver's numbers raise.
    """
    pose, motion, q, dq = astuple(state.pose), astuple(state.motion), state.q, state.dq
    numbers = (state.t, *pose, *motion, state.gripper, *state.ages, state.delay)
    if set(map(type, (*numbers, *q, *dq))) != FLOATS or not type(q) is type(dq) is tuple:
        # Drivers like to report a quaternion alone, numbers of numpy, or a list that they fill again and again.
        state = state.plain
        pose, motion, q, dq = astuple(state.pose), astuple(state.motion), state.q, state.dq
        numbers = state.numbers
    x, y, _, q_w, q_x, q_y, q_z, yaw = pose
    where, rates = (complex(x, y), yaw, *q), (motion[0], motion[5], *dq)
    if omni:
        where, rates = (where[0], *where), (motion[0], motion[1], *rates[1:])
    wrong = feedback.check(state.t, where, rates, now)
    if not wrong and not isfinite(sum(numbers)):
        wrong = "The robot's feedback of the base is not finite."
    elif not wrong and not -UNIT <= q_w * q_w + q_x * q_x + q_y * q_y + q_z * q_z - 1.0 <= UNIT:
        wrong = "The robot's feedback of the base's attitude is no unit quaternion."
    return state, wrong
