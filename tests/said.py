"""What an operator says, short: a stick of two axes, forward and turning."""

from __future__ import annotations

from typing import Any

from overreach.law.frame import of_two
from overreach.types import BaseTwist, Command, Frame, Twist


def push(v_c: float, w_c: float = 0.0, frame: Frame = Frame.HAND) -> Twist:
    """Return the twist of a stick: v_c forward, w_c about the shoulder or, in `base` and `world`, leftward."""
    return of_two(frame, v_c, w_c)


def said(
    operator: int, seq: int, grip: int, held: bool, v_c: float, w_c: float, frame: Frame = Frame.HAND, **more: Any
) -> Command:
    """Return one message; it echoes the beginning of time unless `seen` says otherwise."""
    return Command(operator, seq, grip, held, push(v_c, w_c, frame), frame, **{"seen": 0.0} | more)


def drives(v_b: float = 0.0, w_b: float = 0.0) -> BaseTwist:
    """Return the twist of a base that does not move sideways."""
    return BaseTwist(v_b, 0.0, w_b)
