"""A law of one's own is any object with a few fields and `split`. This one never lets the base turn."""

from math import sin

import overreach as ov
from overreach.testing.law import check_law


class NeverTurn:
    name, frame, closes_residual = "never-turn", ov.Frame.HAND, True
    workspace, blend, mount = ov.Workspace(), ov.smoothstep(), ov.Mount()

    def split(self, l: float, psi: float, u_r: float, u_t: float) -> ov.Split:
        paper = ov.paper(self.workspace, self.blend).split(l, psi, u_r, 0.0)
        w_m = (u_t * paper.scale + paper.v_b * sin(psi)) / l  # the arm closes what the drive leaves
        return ov.Split(paper.mu, 0.0, paper.v_b, 0.0, paper.v_m, w_m, paper.scale)


law: ov.Law = NeverTurn()
check_law(law)  # finite everywhere, still without a command, and as exact as it says
split = law.split(0.85, 0.0, 0.4, 0.1)
print(f"base {split.v_b:.2f} m/s, turning {split.w_b:.2f} rad/s")
