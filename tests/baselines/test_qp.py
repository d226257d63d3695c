from __future__ import annotations

import math
import random
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from overreach.arm.planar import inverse, polar_rates
from overreach.baselines.holistic import DAMPER_START, DAMPER_STOP, Holistic, damper
from overreach.baselines.holistic import Program as HolisticProgram
from overreach.baselines.qp import PaperQP, Program
from overreach.baselines.solver import SOLVERS, solver
from overreach.baselines.weighted import Weighted
from overreach.control.controller import HandController
from overreach.errors import SetupError, UnknownNameError
from overreach.law.authority import ee_velocity
from overreach.model.planar import planar
from overreach.plugs import load_law
from overreach.robots.kinematic import KinematicRobot
from overreach.run.simulate import simulate
from overreach.types import HandTwist
from overreach.verdicts import Verdict
from tests.laws import Bound, holistic, qp, weighted
from tests.said import push
from tests.strategies import bearings, lengths, speeds

pytestmark = pytest.mark.filterwarnings("ignore:OSQP exited", "ignore:.*raise_error:PendingDeprecationWarning")
AGREE = 1e-4
MODEL = planar()
REFERENCE = qp(solver="quadprog")
EACH = {name: qp(solver=name) for name in SOLVERS}


@pytest.mark.parametrize("name", SOLVERS)
@settings(max_examples=40)
@given(lengths, bearings, st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_solvers_agree(name: str, l: float, psi: float, u_r: float, u_t: float) -> None:
    """Every solver finds what quadprog finds, to 1e-4, with and without limits at work."""
    want, got = REFERENCE.split(l, psi, u_r, u_t), EACH[name].split(l, psi, u_r, u_t)
    assert (got.v_b, got.w_b, got.v_m, got.w_m) == pytest.approx((want.v_b, want.w_b, want.v_m, want.w_m), abs=AGREE)


@given(lengths, bearings, speeds, speeds)
def test_qp_is_damped_least_squares_inside_its_limits(l: float, psi: float, u_r: float, u_t: float) -> None:
    """Where no limit is at work the solution is the closed form q = J^T (J J^T + lambda I)^-1 v_ref."""
    program = Program(PaperQP("daqp"), MODEL)
    theta = inverse(l, psi, 0.5, 0.5, 1)
    j_l, at_rest = polar_rates(theta[1], 0.0, 1.0, 0.5, 0.5)
    J = np.array([[math.cos(psi), 0.0, 0.0, j_l], [0.0, 1.0, 1.0, at_rest]])
    q = J.T @ np.linalg.solve(J @ J.T + PaperQP().damping * np.eye(2), [u_r, u_t / l])
    if np.all(np.abs(q) < program.q_max):
        found = program.solve(*program.problem(MODEL.arm.at(theta, MODEL.mount), u_r, u_t / l, HandTwist()))
        assert found is not None
        assert found == pytest.approx(q, abs=1e-6)


@given(lengths, bearings, st.floats(-5.0, 5.0), st.floats(-5.0, 5.0))
def test_qp_keeps_its_limits_and_is_optimal(l: float, psi: float, v_c: float, w_c: float) -> None:
    """The rates are within q_max, and no feasible step downhill is left (projected gradient is zero)."""
    program = Program(PaperQP("daqp-direct"), MODEL)
    P, q = program.problem(MODEL.arm.at(inverse(l, psi, 0.5, 0.5, 1), MODEL.mount), v_c, w_c, HandTwist())
    found = program.solve(P, q)
    assert found is not None
    assert np.all(np.abs(found) <= program.q_max + 1e-6)
    downhill = found - (P @ found + q)
    assert np.clip(downhill, -program.q_max, program.q_max) == pytest.approx(found, abs=1e-5)


def test_a_solver_that_fails_is_a_verdict_and_a_zero() -> None:
    """A solver that gives up, or raises, makes the law answer zero with NO_SOLUTION; nothing is raised."""
    starved = qp(solver="osqp", max_iter=1)
    raising = qp(solver="daqp-direct")
    raising.planner.__self__._least = "no bounds"
    for law in (starved, raising):
        split = law.split(0.6, 0.2, 0.4, 0.1)
        assert (split.v_b, split.w_b, split.v_m, split.w_m, split.scale) == (0.0,) * 5
        assert split.verdict is Verdict.NO_SOLUTION


@pytest.mark.parametrize("name", SOLVERS)
def test_no_solver_raises(name: str) -> None:
    """Whatever a solver does with a problem that is none, the answer is None."""
    solve = solver(name)
    assert solve("no matrix", np.ones(4), -np.ones(4), np.ones(4)) is None


@pytest.mark.parametrize("name", SOLVERS)
def test_a_mistyped_setting_fails_at_set_up(name: str) -> None:
    """A setting that the solver lacks, or a value it cannot use, is one line at set-up, not NO_SOLUTION for ever."""
    with pytest.raises(UnknownNameError, match=f"setting of the QP solver {name} 'no_such'.*Valid: ") as caught:
        qp(solver=name, no_such=1.0)
    assert "\n" not in str(caught.value)
    with pytest.raises(UnknownNameError, match="Did you mean 'damping'"):
        load_law("qp", {"solver": name, "dampin": 0.1})
    if name != "quadprog":  # its one setting is a switch, and takes anything
        setting = next(key for key in caught.value.valid if "tol" in key or "eps" in key)
        with pytest.raises(SetupError, match=f"cannot use {setting} = 'wide'") as of_value:
            PaperQP(name, settings={setting: "wide"})
        assert "\n" not in str(of_value.value)


@pytest.mark.parametrize("law", [EACH["daqp"], holistic()], ids=lambda law: str(law.name))
def test_what_is_not_finite_has_no_solution(law: Bound) -> None:
    """A command that is not a number is answered with zero and NO_SOLUTION."""
    for bad in (math.nan, math.inf):
        assert law.split(0.6, 0.2, bad, 0.0).verdict is Verdict.NO_SOLUTION


def test_no_solution_reaches_whoever_drives() -> None:
    """In a controller no solution means: the robot stands still, and the verdict says why."""
    robot = KinematicRobot()
    controller = HandController(robot.model, PaperQP("osqp", settings={"max_iter": 1}))
    step = controller.decide(robot.read(0.0), push(0.4, 0.0), 0.005)
    assert step.verdict is Verdict.NO_SOLUTION
    assert step.rates == (0.0,) * 4


@given(lengths, bearings, speeds, speeds)
def test_a_kept_workspace_remembers_nothing(l: float, psi: float, u_r: float, u_t: float) -> None:
    """With its workspace kept daqp gives for a problem what it gives for it alone, whatever it solved before."""
    kept = EACH["daqp-model"]
    alone = qp(solver="daqp-direct").split(l, psi, u_r, u_t)
    kept.split(0.9, -0.5, 3.0, -2.0)
    kept.split(0.5, 0.1, -3.0, 2.0)
    split = kept.split(l, psi, u_r, u_t)
    assert (split.v_b, split.w_b, split.v_m, split.w_m) == pytest.approx(
        (alone.v_b, alone.w_b, alone.v_m, alone.w_m), abs=1e-9
    )


@given(lengths, st.floats(-0.7, 0.7), speeds, speeds)
def test_joints_and_polar_coordinates_ask_the_same(l: float, psi: float, u_r: float, u_t: float) -> None:
    """The polar rates of a plan are those of its joint rates, which move the hand and the base as it says."""
    theta = inverse(l, psi, 0.5, 0.5, 1)
    for law in (EACH["daqp"], holistic(), weighted()):
        split, joints = (plan := law.plan(theta, u_r, u_t)).split, plan.joints
        if joints is not None:
            one, two = joints
            assert polar_rates(theta[1], one, two, 0.5, 0.5) == pytest.approx((split.v_m, split.w_m), abs=1e-9)


def test_weighted_goes_through_its_singularity() -> None:
    """A law that decides joint rates is asked with the joints as they are: the elbow may change its side."""
    rows = simulate("mixed", Weighted(10.0)).rows
    elbow = [row.theta[1] for row in rows]
    assert min(elbow) < -0.1
    assert max(elbow) > 0.1
    still = sum(a == b for a, b in pairwise(elbow) if abs(a) < 0.05)
    assert still < 0.05 * len(elbow)


def test_unknown_solvers_and_dampings_are_refused() -> None:
    """A solver that is not there is refused with those that are; so is a damping that damps nothing."""
    with pytest.raises(UnknownNameError, match="Did you mean 'quadprog'"):
        solver("quadprg")
    for bad in (0.0, -1.0, math.nan):
        with pytest.raises(SetupError, match="damping"):
            qp(damping=bad)


@given(lengths, bearings, st.floats(0.05, 0.4), speeds, st.randoms(use_true_random=False))
def test_holistic_finds_the_best_of_all_that_is_allowed(
    l: float, psi: float, u_r: float, u_t: float, chance: random.Random
) -> None:
    """J q + delta = u in true kinematics, q within limits and dampers, and nothing allowed costs less."""
    law, program = holistic(), HolisticProgram(Holistic(), MODEL)
    theta = inverse(l, psi, 0.5, 0.5, 1)
    j_l, j_psi = polar_rates(theta[1], 0.0, 1.0, 0.5, 0.5)
    Q, C, lb, ub, A, b = program.problem(MODEL.arm.at(theta, MODEL.mount), HandTwist(u_r, u_t))

    def completed(q: list[float]) -> Any:
        """Return q with the slack that makes it carry out the command."""
        return np.array([*q, *(b - A[:, :4] @ q)])

    def cost(x: Any) -> float:
        return float(0.5 * x @ Q @ x + C @ x)

    split = law.split(l, psi, u_r, u_t)
    dtheta_2 = split.v_m / j_l
    x = completed([split.v_b, split.w_b, split.w_m - j_psi * dtheta_2, dtheta_2])
    assert np.all(x >= lb - 1e-6)
    assert np.all(x <= ub + 1e-6)
    got = ee_velocity(l, psi, split.v_b, split.w_b, split.v_m, split.w_m, (0.0, 0.0, 0.0))
    assert got == pytest.approx(b - x[4:], abs=1e-9)
    for _ in range(20):
        near = chance.choice((1.0, 0.1, 0.01))
        q = [chance.uniform(low, high) for low, high in zip(lb[:4], ub[:4], strict=True)]
        other = completed([(1.0 - near) * mine + near * it for mine, it in zip(x[:4], q, strict=True)])
        if np.all(np.abs(other[4:]) <= ub[4:]):
            assert cost(other) >= cost(x) - 1e-6


def test_holistic_turns_the_base_to_the_hand_and_keeps_the_arm_bent() -> None:
    """Pushed on, the base comes to face the hand, and the arm goes to where it is most manipulable: theta_2 = pi/2."""
    robot = KinematicRobot(MODEL, psi=0.4, l=0.8)
    controller = HandController(robot.model, Holistic())
    for k in range(4000):
        step = controller.decide(robot.read(k * 0.005), push(0.3, 0.0), 0.005)
        robot.write(step.base, step.joints, None, k * 0.005, k * 0.005)
    assert abs(step.polar.psi) < 0.02
    assert robot.true.q[1] == pytest.approx(math.pi / 2, abs=0.2)


def test_the_damper_slows_stops_and_backs_out() -> None:
    """Towards a joint limit: free far away, slower within 0.9 rad, still at 0.1 rad, back out nearer than that."""
    assert damper(DAMPER_START + 1e-9) == math.inf
    assert damper(DAMPER_START) == pytest.approx(1.0)
    assert damper(DAMPER_STOP) == pytest.approx(0.0)
    assert damper(0.0) < 0.0


@pytest.mark.parametrize("end", [0.05, 0.999])
def test_holistic_backs_out_of_the_arms_ends(end: float) -> None:
    """Near straight and near folded the elbow is driven back, whatever is commanded."""
    law = holistic()
    outward = end > 0.5
    split = law.split(end, 0.0, 0.4 if outward else -0.4, 0.0)
    assert split.v_m < 0.0 if outward else split.v_m > 0.0
