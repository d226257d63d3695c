"""A telescope to the side, as its maker describes it: what is found, what it keeps, and what is refused."""

from __future__ import annotations

import math
import re
from pathlib import Path

import msgspec
import mujoco
import numpy as np
import pytest

from overreach.arm.spatial.side import Room, SideArm
from overreach.check.check import check
from overreach.check.driven import Driven, drive
from overreach.check.judge import in_world, judge
from overreach.check.properties import outward, properties
from overreach.control.pilot import Pilot
from overreach.errors import MissingExtraError, SetupError, WorkspaceError
from overreach.law.frame import frames_of
from overreach.law.laws import Exact
from overreach.law.side import Side
from overreach.law.usual import usual_law
from overreach.model.catalogue import description_of, load, measured, parts_for
from overreach.model.described import DescribedRobot
from overreach.model.description import Description, MountTable
from overreach.model.mujoco.chain import base_frame
from overreach.model.mujoco.robot import parts_of
from overreach.model.mujoco.source import PACKAGES, spec_of
from overreach.plugs import law_names
from overreach.requests import ArmRequest
from overreach.robots.kinematic import KinematicRobot
from overreach.types import Command, Frame, Twist
from tests.ur5 import written

DT = 0.01


@pytest.fixture(scope="module")
def stretch() -> DescribedRobot:
    model = load("stretch")
    assert isinstance(model, DescribedRobot)
    return model


@pytest.fixture(scope="module")
def description() -> Description:
    return description_of("stretch")[0]


def steps(seconds: float, v: float = 0.0, w: float = 0.0, v_z: float = 0.0, v_y: float = 0.0) -> np.ndarray:
    return np.tile((v, w, v_z, v_y), (round(seconds / DT), 1))


def path_of(model: DescribedRobot, driven: Driven) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the hand's x and y in the world, and its length."""
    _, p, _ = model.arm.posture_at_home.forward(driven.q)
    x, y = in_world(model, driven.base, p)
    return x, y, np.hypot(p[:, 0], p[:, 1])


def test_what_it_is(stretch: DescribedRobot) -> None:
    """Its arm moves the hand along one line: the law is `side`, l counts from the axle's line, its bearing is one."""
    assert isinstance(stretch.arm, SideArm)
    assert stretch.mode == "fixed"
    assert stretch.mount.yaw == pytest.approx(-0.5 * math.pi, abs=1e-5)
    assert stretch.mount.s_y == pytest.approx(0.0, abs=1e-6)
    assert abs(stretch.mount.s_x) < 0.03
    assert isinstance(usual_law(stretch), Side)
    assert law_names(stretch) == ["side"]
    assert "side" not in law_names(load("mobile4"))
    chain = stretch.arm.at(stretch.arm.home, stretch.mount)
    assert chain.facing == pytest.approx(0.5 * math.pi, abs=1e-4)  # the gripper points where the base drives
    most = stretch.command
    assert (most.v_c, most.w_c, most.v_z) == (0.15, 0.15, 0.05)


def test_its_kinematics_are_mujocos(stretch: DescribedRobot, description: Description) -> None:
    """The hand's place, on the wrist's yaw axis to 0.2 mm, and its attitude, at random joints: MuJoCo's to 1e-9."""
    model = parts_for("stretch").model
    data = mujoco.MjData(model)
    random = np.random.default_rng(1)
    for _ in range(100):
        q = random.uniform([one.lower for one in stretch.arm.channels], [one.upper for one in stretch.arm.channels])
        for group, value in zip(description.arm.groups, q, strict=True):
            for name in group:
                data.qpos[model.joint(name).qposadr[0]] = value / len(group)
        mujoco.mj_kinematics(model, data)
        R, p = base_frame(model, data, description)
        hand = model.body(description.hand.body).id
        R_h = data.xmat[hand].reshape(3, 3)
        place = R.T @ (data.xpos[hand] + R_h @ np.array(description.hand.offset) - p)
        chain = stretch.arm.at(tuple(q.tolist()), stretch.mount)
        assert chain.hand == pytest.approx(place, abs=1e-9)
        assert chain.attitude == pytest.approx(R.T @ R_h, abs=1e-9)
    wrist = model.joint("joint_wrist_yaw")
    for yaw in (0.0, 1.0, 3.0):
        home = (0.6, 0.3, yaw, 0.0, 0.0)
        assert stretch.arm.at(home, stretch.mount).hand[:2] == pytest.approx(
            stretch.arm.at((0.6, 0.3, 0.0, 0.0, 0.0), stretch.mount).hand[:2], abs=3e-4
        )
    assert wrist.range == pytest.approx((-1.75, 4.0))


@pytest.mark.parametrize("mode", ["fixed", "follow"])
def test_its_workspace_is_what_is_measured(mode: str, description: Description) -> None:
    """What ships is what measuring gives, for this model."""
    shipped = description.workspace[mode]
    found = measured(parts_for("stretch", mode)).measured
    assert found.model == shipped.model
    assert found == shipped


@pytest.mark.parametrize("mode", ["fixed", "follow"])
def test_it_keeps_every_property(mode: str) -> None:
    """Streams of its full deflection, a straight line, re-centring, a circle, a reach along the telescope."""
    own = properties(f"stretch#{mode}", 6, 1, jobs=1)
    assert [one.name for one in own if not one.kept] == []


def test_streams_are_exact_and_hardly_ever_wait() -> None:
    """SWINGING counts as OK where the twist is scale x command; the scale is 0.95 and more in the mean."""
    found = check("stretch", 40, 3, jobs=1)
    assert found.ok_share >= 0.995
    assert found.mean_scale >= 0.95
    assert found.ee_error_max < 1e-3
    assert found.ee_error_rms < 1e-5
    assert (found.joint_limit_violations, found.self_contacts, found.lateral_base_max) == (0, 0, 0.0)
    assert found.reach_base_path < 1e-6


@pytest.mark.parametrize(
    ("name", "commands"),
    [
        ("out and back", (steps(26.7, v_y=-0.15), steps(1.5), steps(26.7, v_y=0.15), steps(1.5))),
        ("forward and back", (steps(26.7, 0.15), steps(1.5), steps(26.7, -0.15), steps(1.5))),
        ("around a corner", (steps(13.3, 0.15), steps(13.3, v_y=-0.15), steps(1.5))),
        ("around a corner by turning", (steps(13.3, 0.15), steps(10.5, 0.15, -0.15), steps(13.3, 0.15), steps(1.5))),
        ("aslant", (steps(26.7, 0.106, v_y=-0.106), steps(1.5))),
    ],
)
def test_four_metres(stretch: DescribedRobot, name: str, commands: tuple[np.ndarray, ...]) -> None:
    """Out, sideways, around a corner: every step is OK, the hand where it should be, and the arm back at mid-reach."""
    driven = drive(stretch, np.concatenate(commands))
    judged = judge(stretch, driven, lambda _: False)
    assert judged.ok.all()
    assert judged.off_v.max() < 1e-3
    assert judged.violations == 0
    assert driven.scale.mean() > 0.85
    assert set(driven.verdicts) <= {"moving", "swinging", "acceleration", "released"}
    _, _, l = path_of(stretch, driven)
    space = stretch.workspace
    assert space.l_min - 0.003 <= l.min()
    assert l.max() <= space.l_max + 0.003
    assert abs(l[-1] - 0.5 * (space.l_min + space.l_max)) < 0.02
    waited = (np.array(driven.verdicts) == "swinging").sum() * DT
    assert (waited > 0.0) == (name in ("out and back", "around a corner", "aslant"))
    assert waited < 8.0


def test_straight_out_stays_straight(stretch: DescribedRobot) -> None:
    """While the base swings round below it the hand keeps its line and its attitude: 0.1 mm, and 0.001 rad."""
    driven = drive(stretch, outward(stretch, 2000))
    x, y, _ = path_of(stretch, driven)
    assert np.ptp(x) < 1e-4
    assert y[0] - y[-1] > 2.0
    assert driven.base[-1, 2] == pytest.approx(0.5 * math.pi, abs=0.02)
    judged = judge(stretch, driven, lambda _: False)
    assert judged.off_w.max() < 1e-3


@pytest.mark.parametrize("mode", ["fixed", "follow"])
@pytest.mark.parametrize("aslant", [0.01, -0.01, 0.05, -0.05])
@pytest.mark.parametrize("out", [1.0, -1.0])
def test_out_a_little_aslant(mode: str, aslant: float, out: float) -> None:
    """In either sense of the swing: the hand never exceeds the stick, no edge is passed, every step is OK."""
    model = load(f"stretch#{mode}")
    assert isinstance(model, DescribedRobot)
    driven = drive(model, steps(15.0, aslant, v_y=-0.15 * out))
    judged = judge(model, driven, lambda _: False)
    assert judged.ok.all()
    x, y, l = path_of(model, driven)
    assert np.hypot(np.diff(x), np.diff(y)).max() / DT < 0.151
    assert model.workspace.l_min - 1e-3 <= l.min()
    assert l.max() <= model.workspace.l_max + 1e-3
    assert driven.scale[-1] > 0.95


def test_only_ways_that_stay_in_the_world(stretch: DescribedRobot) -> None:
    """A way that turns with the base would have it swing for ever: refused, with the frame; others are followed."""
    for frame, moves in ((Frame.BASE, False), (Frame.POLAR, False), (Frame.WORLD, True), (Frame.TOOL, True)):
        pilot, robot = Pilot(stretch), KinematicRobot(stretch)
        pilot.ask(ArmRequest(1), 0.0)
        for k in range(50):
            said = Command(1, k + 1, 1, True, Twist(0.1), frame, seen=k * DT)
            tick = pilot.tick(robot.read(k * DT), said, k * DT, DT)
            robot.write(tick.base, tick.joints, None, k * DT, (k + 1) * DT)
        assert (tick.sentence == f"It has no frame {frame.value!r}. The robot's hand cannot move so.") is not moves
        assert bool(tick.base.v_x or any(tick.joints)) is moves
    assert frames_of(stretch.arm) == (Frame.HAND, Frame.WORLD, Frame.TOOL)
    follows = load("stretch#follow")
    assert frames_of(follows.arm) == (Frame.HAND, Frame.WORLD)


def test_a_base_that_swings_can_always_stop(stretch: DescribedRobot) -> None:
    """Sticks thrown in all directions, sideways too: no limit is passed, no contact, and it always comes to rest."""
    random = np.random.default_rng(7)
    contacts = parts_for("stretch").contacts(0.5)
    for _ in range(6):
        throws = [
            steps(float(random.uniform(0.3, 2.5)), *(random.choice((-1.0, 0.0, 1.0), 4) * (0.15, 0.15, 0.05, 0.15)))
            for _ in range(12)
        ]
        driven = drive(stretch, np.concatenate((*throws, steps(2.0))))
        judged = judge(stretch, driven, lambda q: bool(contacts.touching(q)))
        assert (judged.violations, judged.contacts) == (0, 0)
        assert "fault" not in driven.verdicts
        assert np.abs(driven.twist).max(axis=0) == pytest.approx((0.0, 0.0, 0.0), abs=0.601)
        assert np.abs(np.diff(driven.twist[:, 0])).max() <= stretch.base.dv_max * DT * (1.0 + 1e-9)
        assert np.abs(np.diff(driven.twist[:, 2])).max() <= stretch.base.dw_max * DT * (1.0 + 1e-9)
        assert not driven.twist[-1].any()
        assert not driven.rates[-1].any()


def test_a_turning_that_its_drive_can_follow() -> None:
    """The nearest turning that fits; where none does, the part of the command with which the nearest edge does."""
    room = Room((0.1, 0.0, 0.2), 0.01, 0.1, 0.3, 0.6)
    assert room.within(0.25, -0.5, 0.2) == (0.22, 1.0)  # v = 0.2 - 0.5 w within 0.09 .. 0.11
    assert room.within(0.2, -0.5, 0.2) == (0.2, 1.0)
    turn, part = room.within(0.2, -0.5, 0.4)
    assert turn == pytest.approx(0.3)
    assert -0.5 * turn + part * 0.4 == pytest.approx(0.11)
    turn, part = Room((0.1, 0.0, 0.59), 0.01, 0.1, 0.3, 0.6).within(0.9, 0.0, 0.1)
    assert (turn, part) == (0.6, 1.0)


def test_compiled_and_plain_steps_are_one(stretch: DescribedRobot) -> None:
    """The arm with its drive answers the same with a compiler and without: to 1e-9, over a whole swing."""
    ends = []
    for compiled in (True, False):
        arm = stretch.arm.made(stretch.arm.home, stretch.arm.manner, compiled)
        own = DescribedRobot(
            stretch.name, "", arm, stretch.mount, stretch.base, stretch.workspace, stretch.command, True, "fixed"
        )
        driven = drive(own, outward(own, 600))
        ends.append(np.concatenate((driven.q, driven.base), axis=1))
    assert ends[0] == pytest.approx(ends[1], abs=1e-9)


def test_what_does_not_fit_is_refused(stretch: DescribedRobot, description: Description) -> None:
    """Another law, another way of holding, an omni base, a mount aslant: one line each, with the reason."""
    with pytest.raises(SetupError, match=r"law 'exact' needs an arm that moves its hand about .*'side' is for it"):
        Pilot(stretch, Exact())
    with pytest.raises(WorkspaceError, match="fixed or follow is"):
        parts_for("stretch", "level")
    omni = msgspec.structs.replace(description, base=msgspec.structs.replace(description.base, kind="omni"))
    with pytest.raises(SetupError, match=r"along one line only, on an omni base: no law is for that"):
        parts_of(omni, Path())
    aslant = msgspec.structs.replace(description, mount=MountTable(yaw=-1.2))
    with pytest.raises(SetupError, match=r"lies 21 degrees off square to the way that the base drives: no law"):
        parts_of(aslant, Path())


def test_an_arm_that_sweeps_is_not_taken_for_it(tmp_path: Path) -> None:
    """A stretched or folded arm of hinges moves its hand one way only, too, at that place: it stays what it is."""
    assert not parts_for(written(tmp_path, 0.25), "follow").arm.aside
    for name in ("mobile7", "mobile4", "omni5", "omni7"):
        assert not parts_for(name).arm.aside


def test_a_package_that_is_not_there_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """The line says which extra brings the model, or that some package must."""
    monkeypatch.setitem(PACKAGES, "no_such_stretch", "stretch")
    with pytest.raises(MissingExtraError, match=re.escape("[stretch]")):
        spec_of("package:no_such_stretch/a.urdf", Path())
    with pytest.raises(MissingExtraError, match="install the package that brings 'no_such_module'"):
        spec_of("package:no_such_module/a.urdf", Path())
