"""What most systems do: one stick, and a button that sends it to the arm or to the base."""

from __future__ import annotations

from overreach.law.laws import Law, Share
from overreach.model.model import Model
from overreach.types import Frame, Split


class Separate(Law, frozen=True):
    """Baseline: one stick and a mode button, pressed when the arm ends, then drives the base."""

    name = "separate"
    frame = Frame.POLAR
    closes_residual = False

    def bind(self, model: Model) -> Share:
        """Return all to the arm, or all to the base once the command leads out of the workspace.

        arm: v_m = v_c, w_m = w_c;   base: v_b = v_c, w_b = w_c (the stick's forward is the base's forward).
        """
        space = model.workspace

        def share(l: float, psi: float, u_r: float, u_t: float) -> Split:
            v_c, w_c = u_r, u_t / l
            out_l = l > space.l_max if v_c > 0.0 else v_c < 0.0 and l < space.l_min
            out_psi = psi > space.psi_max if w_c > 0.0 else w_c < 0.0 and psi < space.psi_min
            if out_l or out_psi:
                return Split(1.0, 1.0, v_c, w_c, 0.0, 0.0)
            return Split(0.0, 0.0, 0.0, 0.0, v_c, w_c)

        return share
