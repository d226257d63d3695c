"""Arms of any joints in space: kinematics, inverse, limits and the step, in both of its two writings."""

from __future__ import annotations

import math
from collections import Counter

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.arm.chain import Arm, Chain
from overreach.arm.mount import Mount
from overreach.arm.spatial import asked as asks
from overreach.arm.spatial import step as layout
from overreach.arm.spatial import task
from overreach.arm.spatial.arm import SpatialArm, SpatialChain
from overreach.arm.spatial.attitude import turned, vector
from overreach.arm.spatial.inverse import SLIGHT, damping, inverse, rates
from overreach.arm.spatial.manner import TOL_V
from overreach.arm.spatial.room import NULL_SPEED, SPEED, bounds
from overreach.arm.spatial.screws import Array
from overreach.arm.spatial.settle import Places
from overreach.arm.spatial.settle import _vector as batched
from overreach.arm.spatial.turning import apart, yawed
from overreach.control.pilot import Pilot
from overreach.law.laws import Exact, usual_blend
from overreach.model.catalogue import description_of, load, parts_in
from overreach.model.mujoco.chain import joint_of
from overreach.model.mujoco.robot import Parts
from overreach.requests import ArmRequest
from overreach.robots.kinematic import KinematicRobot
from overreach.testing.arm import check_arm
from overreach.types import Channel, Command, Twist
from overreach.verdicts import Verdict

ROBOTS = [("mobile7", "follow"), ("mobile7", "fixed"), ("mobile4", "follow"), ("omni5", "follow")]
IDS = [f"{name} {mode}" for name, mode in ROBOTS]


def parts(name: str, mode: str = "follow") -> Parts:
    return parts_in(*description_of(name), mode)


def both(arm: SpatialArm, change: float = 1.0, far: float = 10.0) -> tuple[SpatialArm, SpatialArm]:
    """Return the arm compiled and with numpy; joints change their rates `change` times as fast, go `far`."""
    channels = tuple(
        Channel(
            c.name, c.moves, c.unit, c.rate_max, change * c.change_max, max(c.lower, q - far), min(c.upper, q + far)
        )
        for c, q in zip(arm.channels, arm.home, strict=True)
    )
    one, other = [
        SpatialArm(channels, arm.screws, arm.tip, arm.home, arm.manner, compiled) for compiled in (True, False)
    ]
    return one, other


def postures(arm: SpatialArm, many: int, seed: int = 0) -> Array:
    """Return joints (many, n): anywhere, near those that hold the hand as it is to be held, and at limits."""
    random = np.random.default_rng(seed)
    lower, upper, R = arm.limits[:, 0], arm.limits[:, 1], arm.manner.reach
    q = random.uniform(lower, upper, (many, len(lower)))
    home = arm.posture_at_home
    for k in range(many):
        if k % 3 == 0 and k > 0:
            continue
        if k % 200 in (0, 1):
            l, psi = random.uniform(0.55, 0.95) * R, random.uniform(-1.0, 1.0)
            held = np.array(arm.posture(l, psi, home.z + random.uniform(-0.3, 0.3) * R))
        q[k] = np.clip(held + random.normal(0.0, random.choice([0.0, 1e-4, 0.01]), len(lower)), lower, upper)
        if k % 5 == 0:
            joint = random.integers(len(lower))
            q[k, joint] = lower[joint] + 0.021 if random.random() < 0.5 else upper[joint] - 0.021
    return np.asarray(q)


@pytest.mark.parametrize(("name", "mode"), ROBOTS[::2], ids=IDS[::2])
@pytest.mark.parametrize("compiled", [True, False], ids=["compiled", "numpy"])
def test_the_kinematics_are_mujoco_s(name: str, mode: str, compiled: bool) -> None:
    """Pose and Jacobian are those of the robot's own model, to rounding, at any joints."""
    found = parts(name, mode)
    model, description = found.model, found.description
    arm = SpatialArm(found.arm.channels, found.arm.screws, found.arm.tip, found.arm.home, found.arm.manner, compiled)
    data = mujoco.MjData(model)
    joints = [joint_of(model, group[0]) for group in description.arm.groups]
    base, hand = model.body(description.base.body).id, model.body(description.hand.body).id
    offset = np.array(description.hand.offset)
    for q in postures(arm, 60):
        data.qpos[model.jnt_qposadr[joints]] = q
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        R_b, p_b = data.xmat[base].reshape(3, 3), data.xpos[base]
        R_h = data.xmat[hand].reshape(3, 3)
        p_h = data.xpos[hand] + R_h @ offset
        linear, angular = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, linear, angular, p_h, hand)
        columns = model.jnt_dofadr[joints]
        chain = arm.at(tuple(q.tolist()), found.mount)
        assert np.abs(np.array(chain.hand) - R_b.T @ (p_h - p_b)).max() < 1e-12
        assert np.abs(chain.attitude - R_b.T @ R_h).max() < 1e-12
        assert np.abs(chain.J[:3] - R_b.T @ linear[:, columns]).max() < 1e-12  # the arm's axes are the base's here
        assert np.abs(chain.J[3:] - R_b.T @ angular[:, columns]).max() < 1e-12


@pytest.mark.parametrize(("name", "mode"), ROBOTS, ids=IDS)
def test_they_conform(name: str, mode: str) -> None:
    """They keep all the promises of an arm."""
    arm = parts(name, mode).arm
    R = arm.manner.reach
    samples = [arm.posture(l * R, psi) for l in (0.65, 0.8) for psi in (-0.6, 0.0, 0.4)]
    for mount in (Mount(), Mount(0.2, -0.1, 0.3)):
        check_arm(arm, samples, mount)


def asked_at_random(random: np.random.Generator, arm: SpatialArm) -> Array:
    """Return what a step may be asked."""
    n = len(arm.channels)
    size = random.choice([0.1, 1.0, 4.0, 20.0])
    asked = np.zeros(asks.ASKED + n)
    asked[asks.U : asks.U + 3] = random.normal(0.0, 0.1 * size, 3)
    asked[asks.W_C] = random.normal(0.0, 0.3)
    asked[asks.DELTA] = random.uniform(-math.pi, math.pi) * (random.random() < 0.5)
    asked[asks.PLAN : asks.PLAN + 3] = random.normal(0.0, 0.2 * size, 3) * (1.0, random.random() < 0.2, 1.0)
    asked[asks.SLIP : asks.SLIP + 3] = random.normal(0.0, 0.02, 3) * (random.random() < 0.3)
    asked[asks.WAS : asks.WAS + 3] = asked[asks.PLAN : asks.PLAN + 3] + random.normal(0.0, 0.02, 3)
    asked[asks.STEP : asks.STEP + 3] = (0.015, 0.015, 0.04)
    asked[asks.DT] = random.choice([0.005, 0.01])
    asked[asks.S_X : asks.ATTITUDE] = (0.1, 0.05, math.cos(0.2), math.sin(0.2))
    held = arm.R_home
    if random.random() < 0.4:  # turned a little, or much, and turning on
        held = turned(random.normal(0.0, random.choice([0.01, 0.5]), 3)) @ held
        asked[asks.TURN : asks.SPIN] = random.normal(0.0, 0.2, 3) * (random.random(3) < 0.7)
        asked[asks.SPIN] = random.normal(0.0, 0.2) * (random.random() < 0.5)
    asked[asks.ATTITUDE : asks.TURN] = held.ravel()
    asked[asks.ASKED :] = random.normal(0.0, 0.3, n) * (random.random() < 0.7)
    return asked


def turned_to(arm: SpatialArm, hand: Array) -> Array:
    """Return the attitude (9,) that a hand is to have where it is."""
    R = np.empty(9)
    yawed(arm.R_home.ravel(), math.atan2(hand[10], hand[9]), R)
    return R


@pytest.mark.parametrize(("name", "mode"), ROBOTS, ids=IDS)
def test_the_two_writings_agree(name: str, mode: str) -> None:
    """Compiled and numpy, kinematics and step are equal to 1e-9 on 10,000 states, whatever limits them."""
    seen: Counter[int] = Counter()
    ties = 0
    for change, far, many in ((1.0, 10.0, 3000), (1000.0, 10.0, 4000), (1000.0, 0.3, 4000)):
        one, other = both(parts(name, mode).arm, change, far)
        n = len(one.channels)
        random = np.random.default_rng(1)
        for q in postures(one, many):
            poses = [(np.empty(12), np.empty((6, n)), np.empty((n, 3))) for _ in range(2)]
            one.engine.forward(q, *poses[0])
            other.engine.forward(q, *poses[1])
            assert max(np.abs(a - b).max() for a, b in zip(*poses, strict=True)) < 1e-12
            if apart(turned_to(one, poses[0][0]), poses[0][0], np.empty(3)) > 3.0:
                continue  # half a turn has no direction
            asked = asked_at_random(random, one)
            outs = np.empty(n + layout.DONE), np.empty(n + layout.DONE)
            one.engine.step(q, poses[0][0], poses[0][1], asked, outs[0])
            other.engine.step(q, poses[0][0], poses[0][1], asked, outs[1])
            assert np.isfinite(outs[0]).all()
            if outs[0][n + layout.JOINT] != outs[1][n + layout.JOINT]:  # two joints limit alike: either may be named
                ties += 1
                for one_of in (layout.JOINT, layout.WHY):
                    outs[0][n + one_of] = outs[1][n + one_of]
            apart_by = 1e-6 if outs[0][n + layout.WHY] == layout.OFF else 1e-9  # far off, where the arm is singular
            assert np.abs(outs[0] - outs[1]).max() < apart_by, (q.tolist(), asked.tolist(), outs)
            seen[int(outs[0][n + layout.WHY])] += 1
    assert ties < 10
    assert min(seen[why] for why in (layout.FINE, layout.AT_LIMIT, layout.AT_SPEED, layout.CHANGING)) > 10, seen


@pytest.mark.parametrize(("name", "mode"), ROBOTS, ids=IDS)
def test_a_step_ends_where_it_should_or_says_that_it_does_not(name: str, mode: str) -> None:
    """Never is a step whose scale is 1 off by more than the tolerance; no rate passes a speed, no joint its margin."""
    arm = both(parts(name, mode).arm, 1000.0)[0]
    n, random, whole = len(arm.channels), np.random.default_rng(2), 0
    for q in postures(arm, 3000, 3):
        chain = arm.at(tuple(q.tolist()), Mount(0.1, 0.05, 0.2))
        asked = asked_at_random(random, arm)
        out = np.empty(n + layout.DONE)
        arm.engine.step(q, chain.pose, chain.J, asked, out)
        dt = asked[asks.DT]
        after = q + out[:n] * dt
        speed, lower, upper = arm.limits[:, 2], arm.limits[:, 0], arm.limits[:, 1]
        assert (np.abs(out[:n]) <= speed * (1.0 + 1e-9)).all()
        inside = (q >= lower + 0.02) & (q <= upper - 0.02)
        assert (after[inside] >= (lower + 0.02)[inside] - 1e-9).all()
        assert (after[inside] <= (upper - 0.02)[inside] + 1e-9).all()
        if out[n + layout.SCALE] >= 1.0:
            whole += 1
            base = out[n : n + 3] + asked[asks.SLIP : asks.SLIP + 3]
            end = arm.at(tuple(after.tolist()), Mount())
            goal = where(chain.pose[9:], asked[asks.U : asks.U + 3], base, dt)
            assert np.abs(end.pose[9:] - goal).max() <= min(TOL_V * arm.manner.reach, 1e-3) * dt * (1.0 + 1e-6)
    assert whole > 200


def where(hand: Array, u: Array, base: Array, dt: float) -> Array:
    """Return where u takes the hand, seen from where the base twist has taken the arm: by many small steps."""
    c, s = math.cos(0.2), math.sin(0.2)
    v_x, v_y = base[0] - base[2] * 0.05, base[1] + base[2] * 0.1
    v, w = np.array((c * v_x + s * v_y, c * v_y - s * v_x)), base[2]
    place, heading, many = np.zeros(2), 0.0, 400
    for _ in range(many):
        middle = heading + 0.5 * w * dt / many
        turn = np.array(((math.cos(middle), -math.sin(middle)), (math.sin(middle), math.cos(middle))))
        place, heading = place + turn @ v * dt / many, heading + w * dt / many
    turn = np.array(((math.cos(heading), -math.sin(heading)), (math.sin(heading), math.cos(heading))))
    goal = turn.T @ (hand[:2] + u[:2] * dt - place)
    return np.array((*goal, hand[2] + u[2] * dt))


def test_the_inverse_is_the_damped_weighted_one() -> None:
    """Rates are w A^T (A w A^T + lambda^2)^-1 x, undamped they give x; sigma is the least of A sqrt(w)."""
    random = np.random.default_rng(0)
    for _ in range(200):
        m, n = 6, 8
        A = random.normal(0.0, 1.0, (m, n))
        A[0] *= random.choice([1.0, 0.05])
        w, free, x = random.uniform(0.5, 2.0, n), np.ones(n), random.normal(0.0, 1.0, m)
        B, out = np.empty((m, m)), np.empty(n)
        sigma = inverse(A, w, free, 0.1, B)
        rates(A, w, free, B, x, out)
        true = np.linalg.svd(A * np.sqrt(w), compute_uv=False)[-1]
        if sigma < 0.1:  # where it matters; elsewhere it is at most the true one, and surely enough
            assert sigma == pytest.approx(true, rel=0.02)
            assert sigma >= true * (1.0 - 1e-9)
        else:
            assert sigma <= true * (1.0 + 1e-9) or sigma == pytest.approx(true, rel=0.02)
        lam2 = damping(sigma, 0.1) + SLIGHT * float(np.trace((A * w) @ A.T))
        assert out == pytest.approx(
            w * (A.T @ np.linalg.solve((A * w) @ A.T + lam2 * np.eye(m), x)), rel=1e-6, abs=1e-9
        )
        if sigma >= 0.1:
            assert A @ out == pytest.approx(x, abs=1e-8)


@pytest.mark.parametrize("mode", ["follow", "fixed"])
def test_the_posture_rests_where_the_workspace_was_measured(mode: str) -> None:
    """A hand that stands still draws its arm to the posture of its place that the walk finds, from wherever it was.

    On its way no joint has more than its part of its speed.
    """
    arm = parts("mobile7", mode).arm
    n, R, home = len(arm.channels), arm.manner.reach, arm.posture_at_home
    fastest = []
    for l, psi, z in ((0.62, -0.9, 0.2), (0.62, 0.9, -0.3), (0.85, 0.4, 0.3), (0.7, 0.0, 0.0)):
        place = Places(np.array([l * R]), np.array([psi]), np.array([home.z + z * R]), np.zeros(1))
        walked = np.array([arm.posture(l * R, psi, home.z + z * R)])
        rests = home.settle(walked, place, place, walk=1000, rest=0).q[0]  # to its very end
        _, _, V = np.linalg.svd(home.task_jacobian(rests[None])[0])
        away = rests + 0.6 * V[-1] / abs(V[-1]).max()  # where the hand stays, to the first order
        away = np.clip(away, arm.limits[:, 0] + 0.1, arm.limits[:, 1] - 0.1)
        q = home.settle(away[None], place, place, rest=0).q[0]
        asked = np.zeros(asks.ASKED + n)
        asked[asks.DT], asked[asks.COS], asked[asks.STEP : asks.STEP + 3] = 0.01, 1.0, 0.02
        out = np.empty(n + layout.DONE)
        hand, jacobian, places = np.empty(12), np.empty((6, n)), np.empty((n, 3))
        for _ in range(2000):
            arm.engine.forward(q, hand, jacobian, places)
            arm.engine.step(q, hand, jacobian, asked, out)
            asked[asks.ASKED :] = out[:n]
            q = q + out[:n] * 0.01
            fastest.append(float((abs(out[:n]) / arm.limits[:, SPEED]).max()))
        assert math.hypot(hand[9], hand[10]) == pytest.approx(l * R, abs=1e-3)
        assert q == pytest.approx(rests, abs=0.005)
    assert max(fastest) <= NULL_SPEED + 1e-3


@given(
    start=st.floats(-1.0, 1.0), wanted=st.lists(st.floats(-5.0, 5.0), min_size=1, max_size=60),
    dt=st.sampled_from([0.001, 0.005, 0.01, 0.02]), braking=st.floats(0.5, 20.0), speed=st.floats(0.1, 5.0),
)  # fmt: skip
def test_a_joint_within_its_bounds_can_always_stop(
    start: float, wanted: list[float], dt: float, braking: float, speed: float
) -> None:
    """Whatever rates are wanted, held to the bounds: the joint keeps its margin, and braking keeps it in them."""
    limits = np.array([[-1.1, 1.1, speed, braking, 2.0 * braking, 0.0, 1.0]])
    q, low, high, rate = np.array([start]), np.empty(1), np.empty(1), 0.0
    for one in wanted:
        bounds(limits, q, dt, 0.02, low, high)
        slowed = rate - math.copysign(min(abs(rate), braking * dt), rate)
        assert low[0] - 1e-9 <= slowed <= high[0] + 1e-9
        rate = max(low[0], min(high[0], one))
        q = q + rate * dt
        assert -1.08 - 1e-9 <= q[0] <= 1.08 + 1e-9


@given(wanted=st.floats(-math.pi, math.pi), most=st.floats(0.1, 1.5))
def test_a_fixed_yaw_yields_smoothly(wanted: float, most: float) -> None:
    """f is what is wanted near the bearing, at most D, continuous with the slope it says, and 0 at half a turn."""
    f, slope = task.yielding(wanted, most)
    assert abs(f) <= most + 1e-12
    if abs(wanted) <= 0.8 * most:
        assert (f, slope) == (wanted, 1.0)
    h = 1e-6
    if abs(wanted) < math.pi - h:
        ahead, behind = task.yielding(wanted + h, most)[0], task.yielding(wanted - h, most)[0]
        assert (ahead - behind) / (2.0 * h) == pytest.approx(slope, abs=1e-3)
    assert task.yielding(math.pi, most)[0] == pytest.approx(0.0, abs=1e-12)
    assert task.yielding(task.wanted(f, most), most)[0] == pytest.approx(f, abs=1e-7)


@pytest.mark.parametrize("robot", ["mobile7", "mobile7#fixed", "mobile4"])
def test_a_hand_that_begins_turned_turns_back_in_its_place(robot: str) -> None:
    """Whatever attitude it begins with, at a stick of 1 cm/s the hand never moves faster: it turns back slowly."""
    model = load(robot)
    n, random, dt = len(model.arm.channels), np.random.default_rng(4), 0.01
    turned_back = 0
    for number in range(24):
        pilot, moves = Pilot(model, Exact(usual_blend(Exact().blend, model))), KinematicRobot(model)
        q = np.array(moves.true.q)
        joints = [n - 1 - number % 3] if number < 16 else range(n - 3, n)  # the wrist: one joint alone, or all
        for k in joints:
            q[k] += random.uniform(0.3, 1.6) * random.choice((-1.0, 1.0))
        limits = [(one.lower + 0.03, one.upper - 0.03) for one in model.arm.channels]
        moves._theta = tuple(float(min(high, max(low, one))) for one, (low, high) in zip(q, limits, strict=True))
        pilot.ask(ArmRequest(1), 0.0)
        places, state = [], moves.read(0.0)
        begun = model.arm.at(state.q, model.mount)
        for k in range(200):
            now = k * dt
            tick = pilot.tick(state, Command(1, k + 1, 1, True, Twist(v_x=0.01), seen=now), now, dt)
            moves.write(tick.base, tick.joints, None, now, now + dt)
            state = moves.read(now + dt)
            x, y, z = model.arm.at(state.q, model.mount).hand
            c, s = math.cos(state.theta_b), math.sin(state.theta_b)
            places.append((state.x_b + c * x - s * y, state.y_b + s * x + c * y, z))
            assert tick.verdict is not Verdict.FAULT
        speeds = np.linalg.norm(np.diff(places, axis=0), axis=1) / dt
        assert speeds.max() <= 0.01 * 1.01, (number, speeds.max(), speeds.argmax())
        ended = model.arm.at(state.q, model.mount)
        turned_back += off_by(model.arm, ended) < off_by(model.arm, begun) - 0.2
    assert turned_back >= 12


def test_a_level_hand_levels_at_its_own_pace() -> None:
    """Its pitch and roll go back at the whole 0.3 rad/s, however far its yaw, which is free, is from the bearing."""
    model, random, dt = load("mobile7#level"), np.random.default_rng(3), 0.01
    for _ in range(6):
        pilot, moves = Pilot(model, Exact(usual_blend(Exact().blend, model))), KinematicRobot(model)
        wrist = random.uniform(-0.6, 0.6, 3)
        moves._theta = (*moves.true.q[:-3], *(moves.true.q[-3:] + wrist).tolist())
        pilot.ask(ArmRequest(1), 0.0)
        state, off = moves.read(0.0), []
        for k in range(60):
            now = k * dt
            off.append(off_level(model.arm, model.arm.at(state.q, model.mount)))
            tick = pilot.tick(state, Command(1, k + 1, 1, True, Twist(v_x=0.01), seen=now), now, dt)
            moves.write(tick.base, tick.joints, None, now, now + dt)
            state = moves.read(now + dt)
        assert off[20] - off[50] == pytest.approx(0.3 * 0.3, rel=0.02)


def off_level(arm: Arm, chain: Chain) -> float:
    """Return how far [rad] a hand is from the pitch and roll that it is to have where it is."""
    assert isinstance(arm, SpatialArm)
    assert isinstance(chain, SpatialChain)
    goal, e = turned_to(arm, chain.pose), np.empty(3)
    apart(goal, chain.pose, e)
    T = np.empty((task.count(arm.manner.held), 6))
    x, y = chain.hand[:2]
    task.rows(arm.manner.held, math.atan2(y, x), goal, np.array(arm.manner.approach), 1.0, T)
    return float(np.linalg.norm(T[3:, 3:] @ e))


def off_by(arm: Arm, chain: Chain) -> float:
    """Return how far [rad] a hand is from the attitude that it is to have where it is."""
    assert isinstance(arm, SpatialArm)
    assert isinstance(chain, SpatialChain)
    return apart(turned_to(arm, chain.pose), chain.pose, np.empty(3))


@given(axis=st.tuples(*[st.floats(-1.0, 1.0)] * 3), angle=st.floats(0.0, math.pi), turn=st.floats(-math.pi, math.pi))
def test_rotation_vectors(axis: tuple[float, float, float], angle: float, turn: float) -> None:
    """The logarithm undoes the exponential, up to half a turn, where either direction is one; scalar and batched."""
    size = math.hypot(*axis)
    if size < 1e-3:
        return
    w = np.array(axis) / size * angle
    found = vector(turned(w))
    assert np.abs(turned(found) - turned(w)).max() < 1e-7
    assert np.abs(batched(turned(w)[None])[0] - found).max() < 1e-9
    if angle < math.pi - 1e-3:
        assert found == pytest.approx(w, abs=1e-9)
    goal, is_ = turned(np.array((0.0, 0.0, turn))) @ turned(w), turned(np.array((0.0, 0.0, turn)))
    between = np.empty(3)
    assert apart(goal.ravel(), is_.ravel(), between) == pytest.approx(angle, abs=1e-7)
    assert np.abs(turned(between) @ is_ - goal).max() < 1e-7


def test_an_arm_folded_back_is_told_of() -> None:
    """An arm that holds its pitch alone, folded over its shoulder: its yaw is half a turn off, and it says OFF."""
    arm = parts("mobile4").arm
    chain = arm.at((-2.292, 1.485, 1.694, -0.450), Mount())
    assert off_by(arm, chain) > 1.5
    for one in both(arm, 1000.0):
        n = len(one.channels)
        asked, out = np.zeros(asks.ASKED + n), np.empty(n + layout.DONE)
        asked[asks.DT], asked[asks.COS], asked[asks.STEP : asks.STEP + 3], asked[0] = 0.01, 1.0, 0.02, 0.01
        one.engine.step(np.array(chain.joints), chain.pose, chain.J, asked, out)
        assert out[n + layout.WHY] == layout.OFF
        assert out[n + layout.SCALE] < 1.0
