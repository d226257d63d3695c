"""The functions of `math` that the law uses, without branches: so that a compiler can do eight robots at once.

What `math` calls is a library routine for one number, at which a loop over many robots stops being vector code.
Here each function is arithmetic and selection alone: range reduction, then a polynomial (Chebyshev interpolation of the
function in 40 digits, rounded once). Against `math`: sin, cos within 2e-16 for |x| <= 1e5, atan, atan2 within 5e-16,
tanh within 3e-16, all absolute (tested); hypot overflows beyond 1e154.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit

compiled: Any = njit(error_model="numpy", fastmath={"contract"}, forceinline=True)

MAGIC = 6755399441055744.0
"""1.5 * 2^52: a number added to it and taken away again is rounded to the nearest integer."""
TWO_OVER_PI = 2.0 / math.pi
# pi/2 in three parts; k times the first two is exact for |k| < 2^20.
HALF_PI_1, HALF_PI_2, HALF_PI_3 = 1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21
TAN_EIGHTH = math.tan(math.pi / 8.0)
LOG2_E = 1.0 / math.log(2.0)
# ln 2 in two parts; k times the first is exact for |k| < 2^11.
LN_2_1, LN_2_2 = 0.693147180559663, 2.8235290563031577e-13


@compiled
def nearest(x: float) -> float:
    """Return the integer nearest to x, |x| < 2^51."""
    return (x + MAGIC) - MAGIC


@compiled
def _wave(x: float, quarter: float) -> float:
    """Return sin(x + quarter pi/2)."""
    k = nearest(x * TWO_OVER_PI)
    r = ((x - k * HALF_PI_1) - k * HALF_PI_2) - k * HALF_PI_3
    z = r * r
    z_2 = z * z
    z_4 = z_2 * z_2
    # Pairs first, then pairs of pairs (Estrin): the terms do not wait for one another.
    s = (
        (-0.16666666666666666 + 0.008333333333330946 * z)
        + z_2 * (-0.0001984126983675497 + 2.755731610068303e-06 * z)
        + z_4 * (-2.5051131455427946e-08 + 1.591810123027412e-10 * z)
    )
    s = r + r * z * s
    c = (
        (0.041666666666666664 - 0.0013888888888887395 * z)
        + z_2 * (2.4801587298763433e-05 - 2.7557317270560326e-07 * z)
        + z_4 * (2.0876146024689747e-09 - 1.1382614868556325e-11 * z)
    )
    c = 1.0 - 0.5 * z + z_2 * c
    m = k + quarter
    m -= 4.0 * nearest(0.25 * m)  # the quadrant: -2, -1, 0, 1 or 2
    value = c if (m == 1.0 or m == -1.0) else s  # noqa: PLR1714  a set cannot be compiled to a selection
    return -value if (m < 0.0 or m > 1.5) else value


@compiled
def sin(x: float) -> float:
    """Return the sine of x [rad]."""
    return _wave(x, 0.0)


@compiled
def cos(x: float) -> float:
    """Return the cosine of x [rad]."""
    return _wave(x, 1.0)


@compiled
def _atan_to_one(x: float) -> float:
    """Return the arc tangent of 0 <= x <= 1: above tan(pi/8) that of (x - 1)/(x + 1), and pi/4."""
    upper = x > TAN_EIGHTH
    t = (x - 1.0) / (x + 1.0) if upper else x
    z = t * t
    z_2 = z * z
    z_4 = z_2 * z_2
    p = (
        (-0.3333333333333333 + 0.19999999999999804 * z)
        + z_2 * (-0.14285714285659779 + 0.11111111105150588 * z)
        + z_4
        * ((-0.09090908753259112 + 0.07692296368042296 * z) + z_2 * (-0.0666642476020052 + 0.05878927554473807 * z))
        + z_4
        * z_4
        * ((-0.05230443640686948 + 0.045515447340221615 * z) + z_2 * (-0.03456931506332609 + 0.016284375050043393 * z))
    )
    value = t + t * z * p
    return value + 0.25 * math.pi if upper else value


@compiled
def atan(x: float) -> float:
    """Return the arc tangent of x, in [-pi/2, pi/2]."""
    size = x if x >= 0.0 else -x
    steep = size > 1.0
    value = _atan_to_one(1.0 / size if steep else size)
    value = 0.5 * math.pi - value if steep else value
    return value if x >= 0.0 else -value


@compiled
def atan2(y: float, x: float) -> float:
    """Return the angle of (x, y), in [-pi, pi]; 0 for (0, 0). A zero's sign is not looked at."""
    across = x if x >= 0.0 else -x
    up = y if y >= 0.0 else -y
    steep = up > across
    high = up if steep else across
    low = across if steep else up
    value = _atan_to_one(low / high if high > 0.0 else 0.0)
    value = 0.5 * math.pi - value if steep else value
    value = math.pi - value if x < 0.0 else value
    return value if y >= 0.0 else -value


@compiled
def tanh(x: float) -> float:
    """Return the hyperbolic tangent of x: 1 - 2/(exp(2 x) + 1)."""
    t = 2.0 * x
    t = 40.0 if t > 40.0 else t
    t = -40.0 if t < -40.0 else t
    k = nearest(t * LOG2_E)
    r = (t - k * LN_2_1) - k * LN_2_2
    p = 2.092158893897149e-09
    p = p * r + 2.511488209588034e-08
    p = p * r + 2.7557251877225084e-07
    p = p * r + 2.755722492065214e-06
    p = p * r + 2.480158735013993e-05
    p = p * r + 0.00019841269909257902
    p = p * r + 0.0013888888888871874
    p = p * r + 0.008333333333309509
    p = p * r + 0.04166666666666669
    p = p * r + 0.16666666666666702
    p = p * r + 0.5
    p = p * r + 1.0
    p = p * r + 1.0
    # 2^k: the low bits of k + MAGIC are k, and go where a float keeps its exponent.
    bits = (np.float64(k + MAGIC).view(np.int64) + np.int64(1023)) << np.int64(52)
    return 1.0 - 2.0 / (p * np.int64(bits).view(np.float64) + 1.0)


@compiled
def hypot(x: float, y: float) -> float:
    """Return sqrt(x^2 + y^2)."""
    return math.sqrt(x * x + y * y)


@compiled
def copysign(size: float, sign: float) -> float:
    """Return |size| with the sign of `sign`; a zero counts as positive."""
    value = size if size >= 0.0 else -size
    return value if sign >= 0.0 else -value


INSTEAD: dict[Any, Any] = {
    math.sin: sin,
    math.cos: cos,
    math.atan: atan,
    math.atan2: atan2,
    math.tanh: tanh,
    math.hypot: hypot,
    math.copysign: copysign,
}
"""What each function of `math` is replaced with where the law is compiled."""
