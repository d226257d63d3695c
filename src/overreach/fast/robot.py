"""Law and full planar step for one robot, compiled, with the robot's constants built in."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import float64, njit

from overreach.fast.compiling import compiled
from overreach.fast.step import planar_step
from overreach.law import authority
from overreach.law.blend import Blend, Smoothstep
from overreach.law.laws import constants
from overreach.model.planar import PlanarRobot, planar

Rates = tuple[float, float, float, float]


def entry(function: Any, arguments: int) -> Callable[..., Any]:
    """Return `function` of so many floats, compiled, without numba's choice among types before every call.

    The choice costs 0.15 us, more than the step itself. What is called instead is the compiled function's own entry.
    """
    made = njit((float64,) * arguments, error_model="numpy")(function)
    (found,) = made.overloads.values()
    call: Callable[..., Any] = found.entry_point  # type: ignore[attr-defined]  # numba's types lack it
    return call


def compile_law(
    robot: PlanarRobot | None = None, blend: Blend | None = None
) -> Callable[[float, float, float, float], authority.Shares]:
    """Return the exact law, (l, psi, u_r, u_t) -> (mu, sigma, v_b, w_b, v_m, w_m, scale); see `law.authority.exact`."""
    blend = blend or Smoothstep()
    limits, three = constants(robot or planar(), blend)
    law, rise = compiled(authority.exact), compiled(blend.rise)

    def fixed(l: float, psi: float, u_r: float, u_t: float) -> Any:
        return law(l, psi, u_r, u_t, rise, limits, three)

    return entry(fixed, 4)


def compile_step(
    robot: PlanarRobot | None = None, blend: Blend | None = None
) -> Callable[[float, float, float, float, float, float], Rates]:
    """Return the full planar step with the exact law; see `fast.step.planar_step`.

    (theta_1, theta_2, theta_b, theta_e [rad], v_c [m/s], w_c [rad/s]) -> (v_b [m/s], w_b, dtheta_1, dtheta_2 [rad/s])
    """
    fixed = fixed_step(robot or planar(), blend or Smoothstep())

    def one(theta_1: float, theta_2: float, theta_b: float, theta_e: float, v_c: float, w_c: float) -> Any:
        return fixed(theta_1, theta_2, theta_b, theta_e, v_c, w_c)

    return entry(one, 6)


def empty_call() -> Callable[..., Rates]:
    """Return a compiled function of six floats that gives four of them back: what a call costs with nothing in it."""

    def nothing(a: float, b: float, c: float, d: float, _e: float, _f: float) -> Any:
        return a, b, c, d

    return entry(nothing, 6)


def fixed_step(robot: PlanarRobot, blend: Blend) -> Any:
    """Return the step as a compiled function of six floats that other compiled functions can call."""
    limits, mount = constants(robot, blend)
    a, b = robot.arm.links
    step, rise = compiled(planar_step), compiled(blend.rise)

    @njit(error_model="numpy", fastmath={"contract"}, forceinline=True)
    def fixed(theta_1: float, theta_2: float, theta_b: float, theta_e: float, v_c: float, w_c: float) -> Any:
        return step(theta_1, theta_2, theta_b, theta_e, v_c, w_c, rise, limits, mount, a, b)

    return fixed
