"""A law of one's own: its parameters, and `bind`. This one lets the base turn only so far; 0: never."""

from math import sin
from typing import Annotated

import overreach as ov
from overreach.law.laws import Share
from overreach.model.model import Model
from overreach.parameters import number
from overreach.testing.law import check_law


class SlowTurn(ov.Law, frozen=True):
    """The paper's shares, with less turning of the base; the arm closes what is left."""

    name = "slow-turn"
    turn: Annotated[float, number("part of the turning", "", 0.0, 1.0)] = 0.0

    def bind(self, model: Model) -> Share:
        paper = ov.Paper(ov.Smoothstep()).bind(model)

        def share(l: float, psi: float, u_r: float, u_t: float) -> ov.Split:
            his = paper(l, psi, u_r, u_t)
            w_b = self.turn * his.w_b
            w_m = (u_t * his.scale + his.v_b * sin(psi)) / l - w_b  # the arm closes what the base leaves
            return ov.Split(his.mu, his.sigma, his.v_b, w_b, his.v_m, w_m, his.scale)

        return share


law = SlowTurn(turn=0.2)
check_law(law, ov.planar())  # finite everywhere, still without a command, and as exact as it says
split = law.bind(ov.planar())(0.85, 0.6, 0.4, 0.1)
print(f"base {split.v_b:.2f} m/s, turning {split.w_b:.2f} rad/s")
