"""Blending functions: how authority passes from the arm (0) to the base (1) around a limit.

`rise(e, k)` takes the distance e beyond the limit [m or rad] and a width parameter k.
"""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from math import tanh as hyperbolic_tangent

from overreach.errors import SetupError, UnknownNameError
from overreach.types import Record

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


class Blend(Record, frozen=True):
    """A blending function with its two width parameters, for length (k_l) and bearing (k_psi).

    width_l [m] and width_psi [rad] are the transition widths Q: 1 % to 99 % for tanh, the whole
    support for smoothstep, 0 for step. Make one with `tanh`, `smoothstep` or `step`.
    """

    name: str
    rise: Rise
    k_l: float
    k_psi: float
    width_l: float
    width_psi: float


def _positive(**values: float) -> None:
    for name, value in values.items():
        if not (isfinite(value) and value > 0.0):
            raise SetupError(f"{name} must be a finite number > 0, got {value:g}")


def tanh(alpha: float = 50.0, beta: float = 50.0) -> Blend:
    """Return the paper's blend; alpha [1/m], beta [1/rad], larger is narrower.

    Its arm share never reaches 0: under a held command the EE creeps out of the workspace.
    """
    _positive(alpha=alpha, beta=beta)
    return Blend("tanh", rise_tanh, alpha, beta, LN_99 / alpha, LN_99 / beta)


def smoothstep(q_l: float = 0.1, q_psi: float = 0.1) -> Blend:
    """Return the blend of compact support; q_l [m], q_psi [rad] are the full widths of its bands.

    [L_min - q_l/2, L_max + q_l/2] and [Psi_min - q_psi/2, Psi_max + q_psi/2] are forward invariant.
    """
    _positive(q_l=q_l, q_psi=q_psi)
    return Blend("smoothstep", rise_smoothstep, q_l, q_psi, q_l, q_psi)


def step() -> Blend:
    """Return the hard switch (alpha = beta = infinity)."""
    return Blend("step", rise_step, 1.0, 1.0, 0.0, 0.0)


def blend_from(name: str, alpha: float, beta: float, q_l: float, q_psi: float) -> Blend:
    """Return the blend called `name`, with the parameters that are its own."""
    makers = {
        "tanh": lambda: tanh(alpha, beta),
        "smoothstep": lambda: smoothstep(q_l, q_psi),
        "step": step,
    }
    if name not in makers:
        raise UnknownNameError("blend", name, makers)
    return makers[name]()


BLENDS = {
    "tanh": "the paper's: smooth, but the arm never quite stops",
    "smoothstep": "compact support: the arm ends at a hard limit",
    "step": "the hard switch: chatters at the limits",
}
