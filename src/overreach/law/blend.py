"""Blending functions: how authority passes from the arm (0) to the base (1) around a limit.

`rise(e, k)` takes the distance e beyond the limit [m or rad] and a width parameter k.
"""

from __future__ import annotations

from collections.abc import Callable
from math import tanh as hyperbolic_tangent
from typing import Annotated, Self

from overreach.parameters import Parameters, number

LN_99 = 4.59511985013459
"""ln 99: a tanh blend goes from 1 % to 99 % over ln(99) / alpha."""

Rise = Callable[[float, float], float]


def rise_tanh(e: float, alpha: float) -> float:
    """Return 1/2 (1 + tanh(alpha e)); alpha [1/m or 1/rad]. Source: Kwon et al. 2026, (14), (15)."""
    return 0.5 + 0.5 * hyperbolic_tangent(alpha * e)


def rise_step(e: float, _k: float) -> float:
    """Return 1 beyond the limit, else 0: the hard switch. Source: Kwon et al. 2026, (12), (13)."""
    return 1.0 if e > 0.0 else 0.0


def rise_smoothstep(e: float, q: float) -> float:
    """Return 3 x^2 - 2 x^3 with x = e/q + 1/2 held to [0, 1]; q is the full width [m or rad].

    Exactly 0 below -q/2 and exactly 1 above q/2, so that the arm's part ends at a hard limit.
    """
    x = e / q + 0.5
    if x <= 0.0:
        return 0.0
    if x >= 1.0:
        return 1.0
    return x * x * (3.0 - 2.0 * x)


class Blend(Parameters, frozen=True):
    """Base of the blends: a frozen record of widths that provides `rise` and its width parameters.

    k_l, k_psi: what `rise` takes for length and bearing; width_l [m], width_psi [rad]: the transition widths Q, 1 % to
    99 % for tanh, the whole support for smoothstep, 0 for step.
    """

    @property
    def rise(self) -> Rise:
        """The blending function."""
        raise NotImplementedError

    @property
    def k_l(self) -> float:
        """The width parameter of `rise` in length."""
        raise NotImplementedError

    @property
    def k_psi(self) -> float:
        """The width parameter of `rise` in bearing."""
        raise NotImplementedError

    @property
    def width_l(self) -> float:
        """Transition width in length [m]."""
        return self.k_l

    @property
    def width_psi(self) -> float:
        """Transition width in bearing [rad]."""
        return self.k_psi

    def fitted(self, width_l: float, width_psi: float) -> Self:
        """Return the blend with transitions of these widths [m, rad]; one that has none to choose stays as it is."""
        return self

    def narrowed(self, width_l: float, width_psi: float) -> Self:
        """Return the blend with its transitions no wider than these [m, rad]."""
        return self.fitted(min(self.width_l, width_l), min(self.width_psi, width_psi))


class Tanh(Blend, frozen=True):
    """The paper's: smooth, but the arm never quite stops.

    alpha [1/m], beta [1/rad], larger is narrower. Its arm share never reaches 0: under a held command the EE creeps out
    of the workspace.
    """

    name = "tanh"
    alpha: Annotated[float, number("α  sharpness in l", "1/m", 5.0, 200.0, 1.0, above=0.0)] = 50.0
    beta: Annotated[float, number("β  sharpness in ψ", "1/rad", 5.0, 200.0, 1.0, above=0.0)] = 50.0

    @property
    def rise(self) -> Rise:
        """`rise_tanh`."""
        return rise_tanh

    @property
    def k_l(self) -> float:
        """Alpha."""
        return self.alpha

    @property
    def k_psi(self) -> float:
        """Beta."""
        return self.beta

    @property
    def width_l(self) -> float:
        """ln(99)/alpha [m]."""
        return LN_99 / self.alpha

    @property
    def width_psi(self) -> float:
        """ln(99)/beta [rad]."""
        return LN_99 / self.beta

    def fitted(self, width_l: float, width_psi: float) -> Tanh:
        """Return the blend that goes from 1 % to 99 % over these widths [m, rad]."""
        return Tanh(LN_99 / width_l, LN_99 / width_psi)


class Smoothstep(Blend, frozen=True):
    """Compact support: the arm ends at a hard limit.

    q_l [m], q_psi [rad] are the full widths of its bands: [L_min - q_l/2, L_max + q_l/2] and
    [Psi_min - q_psi/2, Psi_max + q_psi/2] are forward invariant.
    """

    name = "smoothstep"
    q_l: Annotated[float, number("Q  width in l", "m", 0.01, 0.3, 0.01, above=0.0)] = 0.1
    q_psi: Annotated[float, number("Q  width in ψ", "rad", 0.01, 0.6, 0.01, above=0.0)] = 0.1

    @property
    def rise(self) -> Rise:
        """`rise_smoothstep`."""
        return rise_smoothstep

    @property
    def k_l(self) -> float:
        """q_l."""
        return self.q_l

    @property
    def k_psi(self) -> float:
        """q_psi."""
        return self.q_psi

    def fitted(self, width_l: float, width_psi: float) -> Smoothstep:
        """Return the blend with bands of these widths [m, rad]."""
        return Smoothstep(width_l, width_psi)


class Step(Blend, frozen=True):
    """The hard switch: chatters at the limits (alpha = beta = infinity)."""

    name = "step"

    @property
    def rise(self) -> Rise:
        """`rise_step`."""
        return rise_step

    @property
    def k_l(self) -> float:
        """Unused by `rise_step`."""
        return 1.0

    @property
    def k_psi(self) -> float:
        """Unused by `rise_step`."""
        return 1.0

    @property
    def width_l(self) -> float:
        """0 m."""
        return 0.0

    @property
    def width_psi(self) -> float:
        """0 rad."""
        return 0.0
