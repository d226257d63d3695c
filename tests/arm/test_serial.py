"""The house holds for any arm: chains of six and seven joints in space, driven by the unchanged law."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np
import pytest

from overreach.arm.mount import Mount
from overreach.control.pilot import obeys
from overreach.control.tick import Tick
from overreach.gate.limits import Limits
from overreach.law.authority import ee_velocity
from overreach.law.blend import Smoothstep
from overreach.law.body import WholeBody
from overreach.law.laws import Exact
from overreach.plugs import load_law
from overreach.requests import ArmRequest
from overreach.robots.kinematic import KinematicRobot
from overreach.run.scenario import Scenario, builtin_scenarios, load_scenario
from overreach.run.simulate import law_of, pilot_for, simulate, ticks
from overreach.testing.arm import check_arm
from overreach.testing.whole_body import check_whole_body
from overreach.types import Command, Frame, Twist
from overreach.verdicts import Verdict
from tests.serial import SerialArm, SerialRobot, seven, six

ARMS = pytest.mark.parametrize("arm", [six, seven], ids=["6 joints", "7 joints"])


def samples(arm: SerialArm) -> list[tuple[float, ...]]:
    return [arm.posture(l, psi) for l in (0.5, 0.65, 0.8) for psi in (-0.5, 0.1, 0.6)]


@ARMS
@pytest.mark.parametrize("mount", [Mount(), Mount(0.2, -0.1, 0.3)], ids=["centred", "off"])
def test_the_arms_conform(arm: Callable[[], SerialArm], mount: Mount) -> None:
    """Both keep all the promises of an arm."""
    check_arm(arm(), samples(arm()), mount)


@ARMS
@pytest.mark.parametrize("name", ["exact", "paper", "switch", "separate", "weighted", "qp", "holistic"])
def test_laws_and_rivals_conform_on_them(arm: Callable[[], SerialArm], name: str) -> None:
    """Every law and every rival plans for them as for the planar robot: they know no arm but by its Jacobian."""
    check_whole_body(load_law(name), SerialRobot(arm()), cases=60)


def on(scenario: str, arm: SerialArm, duration: float) -> Scenario:
    """Return a built-in scenario with that arm in place of the planar one."""
    given, model = load_scenario(scenario), SerialRobot(arm)
    return msgspec.structs.replace(
        given, model=model, l=model.start.l, psi=0.2, duration=min(duration, given.duration), dt=0.005
    )


def hand_velocity(tick: Tick, model: Any) -> Any:
    """Return J(q) dq and what the base carries, six components in polar axes."""
    state, base = tick.decided.state, tick.base
    chain = model.arm.at(state.q, model.mount)
    v_m, w_m, v_z, *turning = chain.moved(tick.joints)
    u_r, u_t = ee_velocity(chain.l, chain.psi, base.v_x, base.w_z, v_m, w_m, model.mount.three)
    return np.array([u_r, u_t, v_z, *turning[:2], turning[2] + base.w_z])


@ARMS
@pytest.mark.parametrize("scenario", [name for name in sorted(builtin_scenarios()) if "dither" not in name])
def test_the_hand_moves_as_commanded_in_six_components(arm: Callable[..., SerialArm], scenario: str) -> None:
    """The same scenarios, the unchanged law: J(q) dq + carried(base) = s u to 1e-6 in all six components."""
    given = on(scenario, arm(whole=False), 4.0)
    moved = carried = 0.0
    for tick, _ in ticks(given, law_of(given, "exact")):
        u = np.array(msgspec.structs.astuple(tick.decided.u))
        off = np.abs(hand_velocity(tick, given.model) - tick.decided.scale * u).max()
        assert off <= 1e-6, (tick.now, off)
        moved += float(np.abs(u).sum())
        carried += abs(tick.base.v_x) + abs(tick.base.w_z)
    assert moved > 0.0
    assert carried > 0.0 or scenario in ("reach", "left", "right")


@ARMS
def test_all_six_components_are_obeyed(arm: Callable[..., SerialArm]) -> None:
    """Each part of a twist reaches the hand, along the world's axes, carried by the base, limits and guard at work."""
    model = SerialRobot(arm(whole=False))
    assert obeys(model) == {"v_x", "v_y", "v_z", "w_x", "w_y", "w_z", "gripper"}
    scenario = on("outward", model.arm, 4.0)
    pilot = pilot_for(msgspec.structs.replace(scenario, limits=Limits()), Exact(Smoothstep()))
    robot, dt = KinematicRobot(model), 0.005
    pilot.ask(ArmRequest(1), 0.0)
    for k in range(600):
        now = k * dt
        c, s = math.cos(now), math.sin(now)
        twist = Twist(0.2, 0.05, 0.03 * c, 0.1 * s, 0.1 * c, 0.05 * s)
        tick = pilot.tick(robot.read(now), Command(1, k + 1, 1, True, twist, Frame.WORLD, 0.7, now), now, dt)
        robot.write(tick.base, tick.joints, tick.gripper, now, now + dt)
        assert tick.verdict in (Verdict.MOVING, Verdict.ACCELERATION), (now, tick.sentence)
        u = np.array(msgspec.structs.astuple(tick.decided.u))
        off = np.abs(hand_velocity(tick, model) - tick.decided.scale * u).max()
        assert off <= 1e-6, (now, off)
    assert tick.decided.scale == 1.0
    assert robot.true.x_b > 0.2
    assert robot.true.gripper == 0.7


@ARMS
def test_a_period_ends_where_it_should(arm: Callable[[], SerialArm]) -> None:
    """With whole periods the hand of an arm in space follows its command as exactly as the planar one's, to 1e-6 m."""
    given = on("aside", arm(), 5.0)
    done = simulate(given, Exact(Smoothstep()))
    assert done.summary.ee_error_max < 1e-9
    rows = done.rows
    away = max(abs((row.y_e - rows[0].y_e) * math.cos(0.2) - (row.x_e - rows[0].x_e) * math.sin(0.2)) for row in rows)
    assert away < 1e-3
    assert rows[-1].x_b > 0.8


@ARMS
def test_rivals_drive_them(arm: Callable[[], SerialArm]) -> None:
    """The pseudo-inverse is exact on them, too, through a scenario; the quadratic programs move the hand ahead."""
    bodies: dict[str, WholeBody] = {name: load_law(name) for name in ("weighted", "holistic", "qp")}
    for name, body in bodies.items():
        done = simulate(on("outward", arm(), 1.5), body)
        assert set(done.summary.verdicts) == {"moving"}, name
        assert done.rows[-1].x_e - done.rows[0].x_e > 0.3, name
        if name == "weighted":
            assert done.summary.ee_error_max < 1e-6
