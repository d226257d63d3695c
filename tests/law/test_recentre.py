"""Re-centring: while the base carries the hand, the arm comes back to mid-reach, and the hand does not notice."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from overreach.arm.mount import Mount
from overreach.arm.spatial.screws import Array
from overreach.check.driven import Driven, drive
from overreach.control.pilot import Pilot
from overreach.errors import UnknownNameError
from overreach.law import authority
from overreach.law.blend import Blend, Smoothstep
from overreach.law.laws import Exact, Paper, Switch
from overreach.law.recentre import NOT_CARRIED, Carried, Recentring
from overreach.model.described import DescribedRobot
from overreach.model.planar import planar
from overreach.plugs import load_model
from overreach.requests import ArmRequest
from overreach.robots.kinematic import KinematicRobot
from overreach.types import Command, Frame, Twist
from tests.strategies import WORKSPACE, bearings, blends, lengths, limits_of, mounts, speeds

parts, leads = st.floats(0.0, 1.0), st.floats(0.0, 0.25)
DT = 0.005


@settings(max_examples=1_000)
@given(lengths, bearings, speeds, speeds, blends, mounts, parts, leads)
def test_the_hand_does_not_notice(
    l: float, psi: float, u_r: float, u_t: float, blend: Blend, mount: Mount, carried: float, lead: float
) -> None:
    """However far a drive is carried, base and arm together move the hand as commanded: to 1e-9 of its scale."""
    limits = limits_of(WORKSPACE, blend)
    mu, _, v_b, w_b, v_m, w_m, scale = authority.exact(l, psi, u_r, u_t, blend.rise, limits, mount.three, carried, lead)
    size = 1.0 + abs(v_b) + abs(w_b)
    got = authority.ee_velocity(l, psi, v_b, w_b, v_m, w_m, mount.three)
    assert got == pytest.approx((scale * u_r, scale * u_t), abs=1e-9 * size)
    assert 0.0 <= mu <= 1.0
    mu, _, v_x, v_y, w_b, v_m, w_m = authority.omni(
        l, psi, u_r, u_t, 0.2, blend.rise, limits, mount.three, carried, lead
    )
    assert authority.ee_velocity(l, psi, v_x, w_b, v_m, w_m, mount.three, v_y) == pytest.approx((u_r, u_t), abs=1e-9)
    assert 0.0 <= mu <= 1.0


@given(lengths, speeds, parts, leads)
def test_the_arm_goes_outward_no_faster_for_it(l: float, u_r: float, carried: float, lead: float) -> None:
    """Straight ahead the arm's rate in the sense of the drive is never greater: what kept a band keeps it still."""
    blend = Smoothstep()
    limits = limits_of(WORKSPACE, blend)
    free = authority.exact(l, 0.0, u_r, 0.0, blend.rise, limits, Mount().three)[4]
    v_m = authority.exact(l, 0.0, u_r, 0.0, blend.rise, limits, Mount().three, carried, lead)[4]
    assert math.copysign(1.0, u_r) * v_m <= math.copysign(1.0, u_r) * free + 1e-12


@given(parts, parts, speeds, speeds)
def test_a_drive_that_turns_round_is_carried_no_more(part: float, mu: float, before: float, now: float) -> None:
    """What is carried grows with the way that the base goes, to 1; it is 0 again once the sense changes."""
    centring = Recentring(0.2, 0.65, 0.1, 0.25)
    first = Carried(part, math.copysign(1.0, before) if before else 0.0)
    begun = centring.now(first, now)
    after = centring.after(begun, mu, now, DT)
    same = first.sense == (math.copysign(1.0, now) if now else 0.0)
    assert begun.part == (part if same else 0.0)
    if same and now:
        assert after.part == pytest.approx(min(1.0, part + mu * mu * abs(now) * DT / 0.2))
    elif now:
        assert after.part <= mu * mu * abs(now) * DT / 0.2
    assert 0.0 <= after.part <= 1.0


def test_lead_ends_at_mid_reach() -> None:
    """The lead is 0 at mid-reach and behind it, grows to its ratio, and has no step: the arm stops where it should."""
    centring = Recentring(0.2, 0.65, 0.1, 0.25)
    for sense in (1.0, -1.0):
        x = np.linspace(-0.3, 0.3, 6001)
        leads = np.array([centring.lead(0.65 + one, sense) for one in x])
        assert leads[sense * x <= 0.0].max() == 0.0
        assert leads.max() == 0.25 == leads[sense * x >= 0.1 + 1e-12].min()
        assert np.abs(np.diff(leads)).max() < 0.25 * 2.0 / 0.1 * 1.01e-4


def robot_called(name: str) -> DescribedRobot:
    model = load_model(name)
    assert isinstance(model, DescribedRobot)
    return model


def lengths_of(model: DescribedRobot, driven: Driven) -> Array:
    _, p, _ = model.arm.posture_at_home.forward(driven.q)
    return np.hypot(p[:, 0], p[:, 1])


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("name", ["mobile7", "mobile4", "omni7", "omni5"])
def test_after_two_metres_the_arm_is_back(name: str, sense: float) -> None:
    """2 m outward or inward and let go: within 1 cm of mid-reach; on the way every step is whole, bands are kept.

    And fine work after it, a few centimetres out and back, does not move the base at all.
    """
    model = robot_called(name)
    v, space = model.command.v_c, model.workspace
    out = np.tile((sense * v, 0.0, 0.0), (round(2.0 / v / 0.01), 1))
    rest, fine = np.zeros((80, 3)), 0.15 * model.arm.manner.reach * 0.5 / 1.0
    work = np.tile((-sense * 0.3 * v, 0.0, 0.0), (round(0.5 * fine / (0.3 * v) / 0.01), 1))
    driven = drive(model, np.concatenate((out, rest, work, -work, -work, work, rest)))
    l, mid = lengths_of(model, driven), 0.5 * (space.l_min + space.l_max)
    assert abs(l[len(out) + len(rest)] - mid) < 0.01
    assert abs(l[: len(out)] - mid).max() > 0.3 * (space.l_max - space.l_min)
    assert driven.scale.min() == 1.0
    assert space.l_min <= l.min()
    assert l.max() <= space.l_max
    assert np.abs(np.diff(driven.twist[:, 0])).max() / 0.01 <= model.base.dv_max * (1.0 + 1e-9)
    after = driven.base[len(out) + len(rest) :]
    assert np.hypot(*np.diff(after[:, :2], axis=0).T).sum() == 0.0


def test_turning_back_ends_it_without_a_jump() -> None:
    """In the middle of a carried drive the stick is pulled back: the base comes to rest, the arm takes over at once."""
    model = robot_called("mobile7")
    v = model.command.v_c
    back = np.tile((-0.5 * v, 0.0, 0.0), (60, 1))
    driven = drive(model, np.concatenate((np.tile((v, 0.0, 0.0), (300, 1)), back)))
    assert driven.twist[299, 0] > 1.05 * v  # it leads
    assert np.abs(driven.twist[-20:, 0]).max() == 0.0
    assert driven.scale.min() == 1.0
    assert np.abs(np.diff(driven.twist[:, 0])).max() / 0.01 <= model.base.dv_max * (1.0 + 1e-9)


def test_the_base_carries_nothing_back() -> None:
    """The stick goes over slowly, within the base's acceleration: not for a single period does the base follow it."""
    model = robot_called("mobile7")
    v = model.command.v_c
    over = np.zeros((200, 3))
    over[:, 0] = np.linspace(v, -0.2 * v, 200)
    driven = drive(model, np.concatenate((np.tile((v, 0.0, 0.0), (300, 1)), over)))
    assert driven.twist[:, 0].min() > -1e-4 * v
    assert driven.scale.min() == 1.0


def test_letting_go_ends_it() -> None:
    """After a drive that was let go the same push moves the arm first, as if nothing had been."""
    model = robot_called("mobile7")
    pilot, robot = Pilot(model), KinematicRobot(model)
    pilot.ask(ArmRequest(1), 0.0)
    v, paths = model.command.v_c, []
    k, now = 0, 0.0
    for grip, push, seconds in ((1, v, 6.0), (1, 0.0, 1.0), (2, 0.5 * v, 0.3)):
        begin = robot.read(now)
        for _ in range(round(seconds / 0.01)):
            k += 1
            said = Command(1, k, grip, push != 0.0, Twist(push), Frame.HAND, seen=now)
            tick = pilot.tick(robot.read(now), said, now, 0.01)
            robot.write(tick.base, tick.joints, None, now, now + 0.01)
            now += 0.01
        end = robot.read(now)
        paths.append(math.hypot(end.x_b - begin.x_b, end.y_b - begin.y_b))
    assert paths[0] > 1.0
    assert paths[2] == 0.0


def test_where_it_is_on() -> None:
    """Where the workspace was measured, or where it is asked for; never for the paper's laws, nor beyond the base."""
    model = robot_called("mobile7")
    centring = Exact().recentring(model)
    assert centring is not None
    assert centring.ratio == 0.25
    assert Exact(recentre="off").recentring(model) is None
    assert Exact().recentring(planar()) is None
    assert Exact(recentre="on").recentring(planar()) is not None
    assert Paper().recentring(model) is Switch().recentring(model) is None
    slow = replace(planar(), base=replace(planar().base, v_max=planar().command.v_c))
    assert Exact(recentre="on").recentring(slow) is None
    with pytest.raises(UnknownNameError, match="Re-centring"):
        Exact(recentre="sometimes")
    assert Carried(0.0, 0.0) == NOT_CARRIED


@pytest.mark.parametrize("u_t", [0.0, 0.1])
def test_the_planar_robot_s_arm_comes_back_too(u_t: float) -> None:
    """The law alone, integrated: from the outer band back to mid-reach within 2 m; its rates never jump."""
    model = planar()
    law = Exact(recentre="on")
    share, centring = law._share(model), law.recentring(model)
    assert centring is not None
    l, psi, carried, v_b, u_r = 0.8, 0.0, NOT_CARRIED, [], 0.2
    for _ in range(round(2.0 / u_r / DT)):
        split = share(l, psi, u_r, u_t, 0.0, carried.part, centring.lead(l, 1.0) if carried.part else 0.0)
        carried = centring.after(carried, split.mu, u_r, DT)
        l, psi = l + split.v_m * DT, psi + split.w_m * DT
        u_t *= 0.99
        v_b.append(split.v_b)
    assert abs(l - 0.65) < 0.01
    assert np.abs(np.diff(v_b)).max() < 1.5 * DT * 1.0
