"""The simulation against closed forms that do not come from it."""

from __future__ import annotations

import cmath
import math
import random

import msgspec
import numpy as np
import pytest
from scipy.linalg import expm
from scipy.special import wrightomega

from overreach.arm.mount import Mount
from overreach.arm.planar import inverse
from overreach.arm.polar import hand_in_world
from overreach.law.blend import Tanh
from overreach.law.laws import Exact
from overreach.model.planar import planar
from overreach.robots.kinematic import KinematicRobot
from overreach.run.law_alone import LawAlone
from overreach.run.row import row_of
from overreach.run.scenario import parse_scenario
from overreach.run.simulate import Run, law_of, simulate, ticks
from overreach.types import RobotState
from tests.said import drives, push

V = 0.4


def run(text: str, law: str = "exact") -> Run:
    return simulate(parse_scenario(text), law)


def constant(v_c: float, w_c: float, duration: float, extra: str = "", dt: float = 0.001) -> str:
    return f"{extra}\n[command]\nduration = {duration}\ndt = {dt}\nsegments = [{{t = 0.0, v_c = {v_c}, w_c = {w_c}}}]"


def closed_form(e0: float, k: float, speed: float, t: float) -> float:
    """Return the distance beyond the limit at t under a tanh blend: 2 k e + exp(2 k e) = 2 k (speed t + C)."""
    c = e0 + math.exp(2 * k * e0) / (2 * k)
    return float(math.log(wrightomega(2 * k * (speed * t + c)).real) / (2 * k))


@pytest.mark.parametrize("law", ["exact", "paper"])
@pytest.mark.parametrize("k", [10.0, 50.0, 100.0])
@pytest.mark.parametrize("way", ["out", "in", "left", "right"])
def test_l_and_psi_follow_the_closed_form(law: str, k: float, way: str) -> None:
    """With tanh, l(t) and psi(t) are the Wright omega function's, to 1e-4 at 1 ms, through either limit."""
    duration = {"out": 1.2, "in": 1.2, "left": 3.0, "right": 3.0}[way]
    v_c, w_c = {"out": (V, 0.0), "in": (-V, 0.0), "left": (0.0, V), "right": (0.0, -V)}[way]
    done = run(constant(v_c, w_c, duration, f"[law]\nalpha = {k}\nbeta = {k}"), law)
    worst = 0.0
    for row in done.rows:
        want = closed_form(-0.2 if way in ("out", "in") else -0.6, k, V, row.t)
        got = {
            "out": row.l - 0.85,
            "in": 0.45 - row.l,
            "left": row.psi - 0.6,
            "right": -0.6 - row.psi,
        }[way]
        worst = max(worst, abs(got - want))
    assert worst <= 1e-4
    assert done.rows[-1].v_m == pytest.approx((1 - done.rows[-1].mu) * v_c, abs=1e-12)


def test_base_travel_along_r_is_what_the_arm_leaves() -> None:
    """The base has gone v t - (l(t) - l0) when the hand has gone v t straight out."""
    done = run(constant(V, 0.0, 5.0))
    last = done.rows[-1]
    assert last.x_b == pytest.approx(V * last.t - (last.l - 0.65), abs=1e-9)


@pytest.mark.parametrize("alpha", [10.0, 50.0])
def test_tanh_creeps_as_the_logarithm(alpha: float) -> None:
    """Held outward for 60 s, tanh creeps beyond L_max as ln(1 + 2 alpha v t)/(2 alpha); smoothstep ends at its band."""
    text = constant(V, 0.0, 60.0, f"[robot]\nl = 0.6\n[workspace]\nl_max = 0.6\n[law]\nalpha = {alpha}", dt=0.005)
    last = run(text).rows[-1]
    e0 = math.log(1 + 2 * alpha * V * last.t) / (2 * alpha)
    assert last.l - 0.6 == pytest.approx(e0, rel=0.02)
    text = text.replace("[law]", '[law]\nblend = "smoothstep"\nq_l = 0.1')
    assert run(text).rows[-1].l == pytest.approx(0.65, abs=1e-3)
    assert run(text).summary.outside_l <= 0.05 + 1e-12


@pytest.mark.parametrize("centred", [True, False])
def test_the_hand_moves_as_commanded_in_the_world(centred: bool) -> None:
    """Over one step of 1 ms of the moving robot the hand's mean world velocity is the commanded one, to 1e-3 m/s.

    In 10,000 random cases each, with the shoulder on the base's centre and off it.
    """
    chance = random.Random(2026)
    for _ in range(10_000):
        mount = Mount()
        if not centred:
            mount = Mount(chance.uniform(-0.1, 0.2), chance.uniform(-0.1, 0.1), chance.uniform(-0.3, 0.3))
        check_one_step(
            chance.uniform(0.46, 0.93),
            chance.uniform(-0.75, 0.75),
            chance.uniform(-math.pi, math.pi),
            chance.uniform(-0.5, 0.5),
            chance.uniform(-V, V),
            chance.uniform(-V, V),
            mount,
        )


def check_one_step(l: float, psi: float, theta_b: float, turned: float, v_c: float, w_c: float, mount: Mount) -> None:
    dt = 1e-3
    model = planar(mount=mount)
    controller = LawAlone(model, Exact(Tanh()))
    theta = inverse(l, psi, 0.5, 0.5, 1)
    state = RobotState.flat(0.0, 0.3, -0.2, theta_b, 0.0, 0.0, theta, (0.0, 0.0))
    heading = controller.locate(state).theta_e + turned
    controller._theta_e = heading
    step = controller.decide(state, push(v_c, w_c), dt)
    robot = KinematicRobot(model, l=l, psi=psi)
    robot.write(step.base, step.joints, None, 0.0, 0.0)
    after = robot.read(dt)

    def hand(pose: tuple[float, float, float], joints: tuple[float, ...]) -> complex:
        """The hand by its chain of bodies: base, shoulder, two links."""
        turn = pose[2] + mount.yaw
        shoulder = complex(pose[0], pose[1]) + complex(mount.s_x, mount.s_y) * cmath.exp(1j * pose[2])
        return complex(
            shoulder + 0.5 * cmath.exp(1j * (turn + joints[0])) + 0.5 * cmath.exp(1j * (turn + joints[0] + joints[1]))
        )

    before_at, after_at = (0.0, 0.0, 0.0), (after.x_b, after.y_b, after.theta_b)
    # The simulated robot starts at the world's origin; the command is meant in a world turned by theta_b.
    moved = (hand(after_at, after.q) - hand(before_at, theta)) / dt
    sweep = 1j * w_c * l * cmath.exp(1j * (psi + mount.yaw))
    want = v_c * cmath.exp(1j * (heading - theta_b)) + sweep
    assert step.scale == 1.0
    assert abs(moved - want) <= 1e-3


@pytest.mark.parametrize("v_c", [V, -V])
def test_straight_stays_straight(v_c: float) -> None:
    """Pushed straight with the arm 0.4 rad aside, the hand of `exact` draws a straight line; `paper`'s turns off it."""
    text = constant(v_c, 0.0, 20.0, "[robot]\npsi = 0.4")
    rows = run(text).rows
    away = max(abs((row.y_e - rows[0].y_e) * math.cos(0.4) - (row.x_e - rows[0].x_e) * math.sin(0.4)) for row in rows)
    assert away <= 2e-4
    assert abs(rows[-1].psi) < 2e-3
    rows = run(text, "paper").rows
    course = math.atan2(rows[-1].y_e - rows[-2].y_e, rows[-1].x_e - rows[-2].x_e)
    if v_c > 0.0:
        assert abs(course - 0.4) > 0.3
        assert rows[-1].psi == pytest.approx(0.4, abs=1e-9)


@pytest.mark.parametrize(
    ("v_c", "matrix"),
    [(V, [[-1.0, -1.0], [0.0, -1.0]]), (-V, [[1.0, 1.0], [-4.0, -3.0]])],
    ids=["driving", "reversing"],
)
def test_base_lines_up_at_the_rate_of_the_eigenvalues(v_c: float, matrix: list[list[float]]) -> None:
    """A small deviation (delta, psi) dies out as the linear system with the double eigenvalue -V/l says."""
    l = 0.9 if v_c > 0.0 else 0.4
    text = constant(v_c, 0.0, 8.0, f'[robot]\nl = {l}\npsi = 1e-3\n[law]\nblend = "smoothstep"')
    rows = run(text).rows
    system = np.array(matrix) * V / l
    assert np.linalg.eigvals(system) == pytest.approx([-V / l, -V / l], abs=1e-6)
    for row in rows[::200]:
        want = expm(system * row.t) @ [0.0, 1e-3]
        delta = row.theta_e - row.theta_b - row.psi
        assert (delta, row.psi) == pytest.approx(want, abs=4e-6)
        assert row.l == pytest.approx(l, abs=1e-6)


@pytest.mark.parametrize("v_c", [V, -V])
@pytest.mark.parametrize("shoulder", [(0.0, 0.0), (0.15, 0.0), (0.1, 0.08), (-0.1, -0.05)])
@pytest.mark.parametrize("yaw", [0.0, 0.2])
def test_base_ends_behind_the_hand(v_c: float, shoulder: tuple[float, float], yaw: float) -> None:
    """Wherever the shoulder is, the base ends on the hand's line, heading along it, driving and reversing."""
    text = constant(
        v_c,
        0.0,
        40.0,
        f'[robot]\npsi = 0.3\nshoulder = {list(shoulder)}\nmount_yaw = {yaw}\n[law]\nblend = "smoothstep"',
        dt=0.002,
    )
    last = run(text).rows[-1]
    assert last.theta_b == pytest.approx(0.3 + yaw, abs=2e-3)
    offset = (last.x_e - last.x_b) * math.sin(last.theta_e) - (last.y_e - last.y_b) * math.cos(last.theta_e)
    assert offset == pytest.approx(0.0, abs=2e-3)
    assert last.v_b == pytest.approx(v_c, abs=1e-3)


@pytest.mark.parametrize(("law", "duration"), [("exact", 3600.0), ("paper", 600.0)])
def test_smoothstep_never_leaves_its_band(law: str, duration: float) -> None:
    """In an hour of random driving l and psi never leave [L_min - q/2, L_max + q/2], [Psi_min - q/2, Psi_max + q/2]."""
    chance = random.Random(2026)
    rows = []
    t = 0.0
    while t < duration:
        rows.append(f"{{t = {t}, v_c = {chance.uniform(-V, V)}, w_c = {chance.uniform(-V, V)}}}")
        t += chance.uniform(0.2, 8.0)
    text = f'[law]\nblend = "smoothstep"\n[command]\nduration = {duration}\ndt = 0.02\nsegments = [{", ".join(rows)}]'
    least_l = least_psi = math.inf
    scenario = parse_scenario(text)
    for tick, true in ticks(scenario, law_of(scenario, law)):
        row, error = row_of(tick, true, scenario)
        least_l = min(least_l, row.l - 0.40, 0.90 - row.l)
        least_psi = min(least_psi, row.psi + 0.65, 0.65 - row.psi)
        if law == "exact":
            assert math.hypot(*error) <= 1e-9
    assert least_l >= -1e-12
    assert least_psi >= -1e-12
    assert min(least_l, least_psi) < 0.02  # the drive did go to the limits


def test_switch_stays_within_one_step_of_its_limit() -> None:
    """The hard switch passes its limit by at most one step of travel, then the base has it."""
    rows = run(constant(V, 0.0, 3.0), "switch").rows
    assert max(row.l for row in rows) <= 0.85 + V * 0.001 + 1e-12
    assert rows[-1].v_b == V


def test_the_papers_distortion_is_there() -> None:
    """`paper` at psi = 0.4 leaves its command by mu v tan(0.4), seen in where the hand goes, not in its own model."""
    done = run(constant(V, 0.0, 5.0, "[robot]\npsi = 0.4"), "paper")
    assert done.summary.ee_error_max == pytest.approx(V * math.tan(0.4), abs=1e-3)
    one, two = done.rows[-2:]
    went = complex(two.x_e - one.x_e, two.y_e - one.y_e) / 0.001
    wanted = V * complex(math.cos(one.theta_b + one.psi), math.sin(one.theta_b + one.psi))
    assert abs(went - wanted) == pytest.approx(V * math.tan(0.4), abs=1e-3)


def test_reported_error_is_what_the_positions_say() -> None:
    """The EE error in the summary is the one that the hand's positions show, by differences."""
    for law in ("exact", "paper"):
        done = simulate("mixed", law)
        worst = 0.0
        for one, two in zip(done.rows, done.rows[1:], strict=False):
            moved = complex(two.x_e - one.x_e, two.y_e - one.y_e) / 0.001
            bearing = one.theta_b + one.psi
            if law == "exact":
                want = one.v_c * np.exp(1j * one.theta_e) + 1j * one.w_c * one.l * np.exp(1j * bearing)
            else:
                want = (one.v_c + 1j * one.w_c * one.l) * np.exp(1j * bearing)
            worst = max(worst, abs(moved - want))
        assert worst == pytest.approx(done.summary.ee_error_max, abs=1e-3)


def test_arm_makes_up_for_a_base_that_does_otherwise() -> None:
    """If the base was slower than asked, the arm's next rates make the EE exact for the base as it goes on."""
    model = planar()
    controller = LawAlone(model, Exact())
    theta = inverse(0.9, 0.3, 0.5, 0.5, 1)
    state = RobotState.flat(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, theta, (0.0, 0.0))
    first = controller.decide(state, push(V, 0.0), 0.005)
    slip = drives(-0.1, 0.05)
    dt = 1e-6  # a period ends exactly where it should, so that in a short one this moment's rates are seen
    real = RobotState.flat(
        0.005, 0.0, 0.0, 0.0, first.split.v_b + slip.v_x, first.split.w_b + slip.w_z, theta, first.joints
    )
    second = controller.decide(real, push(V, 0.0), dt)
    twist = drives(second.split.v_b + slip.v_x, second.split.w_b + slip.w_z)
    h = 1e-6
    after = (theta[0] + h * second.joints[0], theta[1] + h * second.joints[1])
    ends = []
    for pose, joints in (((0.0, 0.0, 0.0), theta), ((h * twist.v_x, 0.0, h * twist.w_z), after)):
        x = 0.5 * math.cos(joints[0]) + 0.5 * math.cos(joints[0] + joints[1])
        y = 0.5 * math.sin(joints[0]) + 0.5 * math.sin(joints[0] + joints[1])
        ends.append(complex(*hand_in_world(*pose, math.hypot(x, y), math.atan2(y, x), 0.0, 0.0)))
    assert abs((ends[1] - ends[0]) / h - V * np.exp(0.3j)) <= 1e-5
    # Over a real period, too: the hand ends where it should, but for how far the base's arc turns it meanwhile.
    period = 0.005
    later = LawAlone(model, Exact())
    later.decide(state, push(V, 0.0), period)
    whole = later.decide(msgspec.structs.replace(real), push(V, 0.0), period)
    robot = KinematicRobot(model, l=0.9, psi=0.3)
    robot.write(drives(whole.base.v_x + slip.v_x, whole.base.w_z + slip.w_z), whole.joints, None, 0.0, period)
    after_all = robot.read(period)
    hand = model.arm.at(after_all.q, model.mount).hand
    turn = np.exp(1j * after_all.theta_b)
    place = complex(after_all.x_b, after_all.y_b) + turn * complex(hand[0], hand[1])
    assert abs(place - (0.9 + V * period) * np.exp(0.3j)) <= 2e-3 * V * period
