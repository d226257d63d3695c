"""Robots with several hands: one is driven, the others hold still; another is chosen at rest."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace

from overreach.check.check import check
from overreach.control.pilot import Pilot, replay
from overreach.control.tick import Tick
from overreach.errors import SetupError
from overreach.law.usual import usual_law
from overreach.link.messages import Accepted, Choice, ConfigureRequest, Refused
from overreach.model import catalogue
from overreach.model.catalogue import description_of, load, load_one, parts_for
from overreach.model.described import DescribedRobot
from overreach.model.description import read_description
from overreach.model.handed import HandedRobot
from overreach.model.measure.command import run_workspace
from overreach.requests import ArmRequest
from overreach.robot_side.loop import Loop
from overreach.robot_side.settings import build, usual
from overreach.robots.kinematic import KinematicRobot
from overreach.types import Command, Frame, Twist
from tests.pair import BASE, hand_table, written
from tests.processes import Driver, Observer, robot, until

DT = 0.01
ME = 7
ENDS = 6
"""Joints of an arm."""


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A robot with two arms, both measured; what is kept of it is kept for this file's tests alone."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        path = written(tmp_path_factory.mktemp("pair"))
        for hand in ("left", "right"):
            run_workspace(f"{path}@{hand}", "", find_home=False, out=Path(path), figure=None)
        yield path
    catalogue.load.cache_clear()


def handed(which: str) -> HandedRobot:
    model = load(which)
    assert isinstance(model, HandedRobot)
    return model


class Drive:
    """A pilot and its simulated robot, by a clock of their own, with an operator who holds the stick."""

    def __init__(self, model: HandedRobot) -> None:
        self.pilot, self.robot = Pilot(model), KinematicRobot(model)
        self.pilot.ask(ArmRequest(ME), 0.0)
        self.now, self.seq, self.press, self.ticks = 0.0, 0, 1, list[Tick]()

    def push(self, seconds: float, twist: Twist, gripper: float | None = None) -> None:
        for _ in range(round(seconds / DT)):
            self.seq += 1
            said = Command(ME, self.seq, self.press, True, twist, Frame.WORLD, gripper, seen=self.now)
            tick = self.pilot.tick(self.robot.read(self.now), said, self.now, DT)
            self.robot.write(tick.base, tick.joints, tick.gripper, self.now, self.now + DT)
            self.ticks.append(tick)
            self.now += DT

    def drive(self, hand: str) -> None:
        model = self.pilot.model
        assert isinstance(model, HandedRobot)
        other = model.with_hand(hand)
        self.pilot.configure(usual_law(other), other)
        self.robot.choose(hand)

    @property
    def q(self) -> np.ndarray:
        return np.array(self.robot.true.q)


def test_each_hand_alone_is_a_robot(pair: str) -> None:
    """The other's joints are locked at its home; its workspace is its own; streams are exact, nothing touches."""
    for hand, other in (("left", "right"), ("right", "left")):
        description, _ = description_of(f"{pair}@{hand}")
        assert (description.driven, description.hands) == (hand, ("left", "right"))
        assert {f"{other}_pan", f"{other}_turn", "lift"} <= set(description.locked)
        assert not any(joint.startswith(hand) for joint in description.locked)
        model = load_one(f"{pair}@{hand}")
        assert len(model.arm.channels) == ENDS
        found = check(f"{pair}@{hand}", 4, 1, jobs=1)
        assert found.ok_share == 1.0
        assert (found.joint_limit_violations, found.self_contacts) == (0, 0)
    left, right = (load_one(f"{pair}@{hand}").workspace for hand in ("left", "right"))
    assert (left.psi_min, left.psi_max) == (-right.psi_max, -right.psi_min)  # they are each other's mirror image
    text = Path(pair).read_text()
    assert text.count("[hands.left.workspace.follow]") == text.count("[hands.right.workspace.follow]") == 1


def test_together_they_are_one_robot(pair: str) -> None:
    """All joints in one list, each once; the first hand is driven; full deflection is the least of both."""
    model = handed(pair)
    assert model.hands == ("left", "right")
    assert model.hand == "left"
    names = [channel.moves for channel in model.arm.channels]
    assert len(names) == len(set(names)) == 2 * ENDS
    assert model.with_hand("right").arm.channels == model.arm.channels
    assert model.mount.s_y == -model.with_hand("right").mount.s_y != 0.0
    assert model.arm.posture(model.start.l, model.start.psi)[:ENDS] == load_one(f"{pair}@left").arm.posture(
        model.start.l, model.start.psi
    )


@pytest.mark.parametrize("hand", ["left", "right"])
def test_the_others_hold_still(pair: str, hand: str) -> None:
    """Whatever the driven hand does, in all six directions: not a rate, not a place of the other arm changes."""
    drive = Drive(handed(pair).with_hand(hand))
    mine = slice(0, ENDS) if hand == "left" else slice(ENDS, 2 * ENDS)
    others = slice(ENDS, 2 * ENDS) if hand == "left" else slice(0, ENDS)
    begin = drive.q
    random_ = random.Random(3)
    most = drive.pilot.model.command
    for _ in range(12):
        v, w = most.v_c, most.w_c
        sizes = (v, v, most.v_z, w, w, w)
        drive.push(0.8, Twist(*[random_.uniform(-one, one) for one in sizes]))
    rates = np.array([tick.joints for tick in drive.ticks])
    assert not rates[:, others].any()
    assert np.abs(rates[:, mine]).max() > 0.1
    assert (drive.q[others] == begin[others]).all()
    assert "fault" not in {tick.verdict.value for tick in drive.ticks}


def test_another_is_chosen_at_rest_alone(pair: str) -> None:
    """In motion it is refused, with nothing changed; at rest the other goes on from where it is, the first stays."""
    drive = Drive(handed(pair))
    drive.push(1.0, Twist(0.2))
    with pytest.raises(SetupError, match="another hand is driven only from rest"):
        drive.drive("right")
    drive.push(0.5, Twist(0.2))
    assert not np.array(drive.ticks[-1].joints)[ENDS:].any()
    drive.push(1.0, Twist())
    before = drive.q
    drive.drive("right")
    drive.press += 1
    drive.push(1.5, Twist(0.2, 0.05))
    assert (drive.q[:ENDS] == before[:ENDS]).all()
    assert np.abs(drive.q[ENDS:] - before[ENDS:]).max() > 0.05
    at = drive.ticks[-1]
    assert at.decided.polar.l == drive.pilot.model.arm.at(at.decided.state.q, drive.pilot.model.mount).l
    assert {tick.verdict.value for tick in drive.ticks[-100:]} <= {"moving", "acceleration"}


def test_the_hand_goes_where_it_is_sent_after_a_change(pair: str) -> None:
    """The driven hand, by its own arm's kinematics: straight ahead at the commanded speed, to 1e-3 m/s."""
    drive = Drive(handed(pair))
    drive.push(0.6, Twist(0.1))
    drive.push(0.6, Twist())
    drive.drive("right")
    drive.press += 1
    single = load_one(f"{pair}@right")
    drive.push(0.5, Twist(0.1))
    places = []
    for _ in range(100):
        drive.push(DT, Twist(0.1))
        true = drive.robot.true
        x, y, z = single.arm.at(true.q[ENDS:], single.mount).hand
        c, s = math.cos(true.theta_b), math.sin(true.theta_b)
        places.append((true.x_b + c * x - s * y, true.y_b + s * x + c * y, z))
    speed = np.diff(np.array(places), axis=0) / DT
    assert np.abs(speed - (0.1, 0.0, 0.0)).max() < 1e-3


def test_each_has_its_own_gripper(pair: str) -> None:
    """The other's stays as it was, and is still so when it is driven again."""
    drive = Drive(handed(pair))
    drive.push(0.2, Twist(), gripper=0.7)
    drive.drive("right")
    assert drive.robot.true.gripper == 0.0
    drive.press += 1
    drive.push(0.2, Twist(), gripper=0.2)
    drive.drive("left")
    assert drive.robot.true.gripper == 0.7


def test_a_gripper_that_is_held_does_not_go_over(pair: str) -> None:
    """A command that still stands says nothing of another hand's gripper: it needs a press of its own."""
    drive = Drive(handed(pair))
    drive.push(0.2, Twist(), gripper=0.7)
    drive.drive("right")
    for _ in range(3):
        tick = drive.pilot.tick(drive.robot.read(drive.now), None, drive.now, DT)
        drive.robot.write(tick.base, tick.joints, tick.gripper, drive.now, drive.now + DT)
        drive.now += DT
    assert drive.robot.true.gripper == 0.0
    drive.push(0.2, Twist(0.1))  # of the same press
    assert not any(drive.ticks[-1].joints)


def test_a_hand_keeps_the_attitude_that_it_was_turned_to(pair: str) -> None:
    """Pitched, left for the other, driven again: it does not turn back."""
    drive = Drive(handed(pair))
    drive.push(0.8, Twist(w_y=0.3))
    drive.push(0.8, Twist())
    single = load_one(f"{pair}@left")
    turned = single.arm.at(drive.robot.true.q[:ENDS], single.mount).attitude
    for hand in ("right", "left"):
        drive.drive(hand)
        drive.press += 1
        drive.push(0.3, Twist(0.05))
        drive.push(0.5, Twist())
    again = single.arm.at(drive.robot.true.q[:ENDS], single.mount).attitude
    assert abs(turned[2, 0]) > 0.1
    assert np.abs(turned - again)[2].max() < 0.01
    assert np.abs(turned - again).max() < 0.1  # its bearing may have changed a little


def test_a_workspace_made_smaller_is_the_hands_own(pair: str) -> None:
    """It stays in force while that hand is driven, is whole again after a change, and is never the other's."""
    model = handed(pair)
    whole = model.with_hand("right").workspace
    start = usual(model, Choice("exact"))
    right = build(replace(start, hand="right"), model, "left")
    assert right.model.workspace == whole
    small = replace(whole, l_max=whole.l_max - 0.05)
    narrowed = build(replace(right.settings, workspace=small), model, "right")
    assert narrowed.model.workspace == narrowed.settings.workspace == small
    back = build(replace(narrowed.settings, hand="left"), model, "right")
    assert back.model.workspace == model.workspace
    with pytest.raises(SetupError, match="mobile4 has one hand"):
        build(replace(usual(load("mobile4"), Choice("exact")), hand="right"), load("mobile4"))


def test_what_carries_both_is_a_joint_of_both(tmp_path: Path) -> None:
    """A lift in one hand's joints alone would move the other hand unseen; with other speeds it would be two joints."""
    path = Path(written(tmp_path))
    text = path.read_text()
    lift = text.replace("[locked]\nlift = 0.1\n", "")
    for hand, speed in (("left", "0.2"), ("right", "0.1")):
        lift = lift.replace(f'joints = ["{hand}_pan"', f'joints = ["lift", "{hand}_pan"')
        begin = lift.index(f"[hands.{hand}.arm]")
        own = lift[begin:].replace("speed = [", f"speed = [{speed}, ", 1).replace("tion = [", "tion = [2.0, ", 1)
        lift = lift[:begin] + own
    lift = lift.replace("home = [", "home = [0.1, ")
    left_alone = lift.replace('joints = ["lift", "right_pan"', 'joints = ["right_pan"').replace("[0.1, 3.0", "[3.0")
    path.write_text(
        left_alone.replace(
            "[2.0, 15.0, 15.0, 15.0, 20.0, 20.0, 20.0]\n\n[hands.right.hand",
            "[15.0, 15.0, 15.0, 20.0, 20.0, 20.0]\n\n[hands.right.hand",
        )
    )
    description = path.read_text()
    at = description.index("[hands.right]")
    path.write_text(description[:at] + description[at:].replace("home = [0.1, ", "home = ["))
    with pytest.raises(SetupError, match=r"hands\.right: joint 'lift' carries this hand too"):
        parts_for(f"{path}@right")
    path.write_text(lift)
    with pytest.raises(SetupError, match="the joint 'lift' of pair is another's too, with other speeds"):
        load(str(path))


def test_a_driver_without_choose_is_refused_at_the_start(pair: str) -> None:
    """And one that fails at it leaves the hand that was driven, and says so."""

    class Plain:
        simulated = True

        def __init__(self, model: HandedRobot) -> None:
            self.model = model

    with pytest.raises(SetupError, match="its driver has no `choose`"):
        Loop(Plain(handed(pair)), None, None, 200.0)  # type: ignore[arg-type]  # it does not come that far


def test_a_change_of_hand_replays(pair: str) -> None:
    """What was recorded, with a change in it, gives the same through a new pilot."""
    drive = Drive(handed(pair))
    drive.push(0.5, Twist(0.1))
    drive.push(0.6, Twist())
    drive.drive("right")
    drive.press += 1
    drive.push(0.5, Twist(0.1))
    pilot = Pilot(handed(pair))
    assert list(replay(pilot, drive.ticks)) == drive.ticks


@pytest.mark.real_time
@pytest.mark.parametrize("hosted", [True, False], ids=["hosted", "alone"])
def test_by_the_link(pair: str, hosted: bool) -> None:
    """The robot side's own process, and its host: chosen at rest, refused in motion, the gripper is the hand's."""
    with robot(pair, *([] if hosted else ["--no-hosted"])) as (_, _, observer):
        assert observer.welcome.hands == ("left", "right")
        driver = Driver(observer.link, ME)
        settings = observer.welcome.settings
        other = ConfigureRequest(replace(settings, hand="right"))
        driver.arm()
        until(lambda: _pushed(driver, observer), what="motion")
        answer = observer.link.request(other)
        assert isinstance(answer, Refused)
        assert "from rest" in answer.reason
        driver.send(0.0, held=False)
        until(lambda: observer.speed() == 0.0 and observer.now.twist == Twist(), what="rest")
        begin = observer.now.joints
        assert observer.link.request(other) == Accepted()
        until(lambda: observer.now.hand[1] < 0.0, what="the right hand")
        driver.grip += 1
        until(lambda: _pushed(driver, observer), what="motion")
        driver.send(0.0, held=False)
        until(lambda: observer.speed() == 0.0, what="rest")
        assert observer.now.joints[:ENDS] == begin[:ENDS]
        assert observer.now.joints[ENDS:] != begin[ENDS:]


def _pushed(driver: Driver, observer: Observer) -> bool:
    driver.send(0.1)
    return observer.speed() > 0.05


BAD = {
    "beside": ("home = [0.0]\n" + BASE, "home belongs under each of its hands"),
    "no table": (BASE.replace("[base]", "hands = 2\n[base]"), r"hands must be tables, such as \[hands.left.arm\]"),
    "unknown": (BASE + hand_table("left", 'colour = "red"'), "hands.left: unknown key 'colour'"),
    "home": (BASE + hand_table("left").replace("home = [0.0, ", "home = ["), "home must be a number for each of its 6"),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_tables_say_what(what: str) -> None:
    """One line, with the hand and the key."""
    text, said = BAD[what]
    if what == "beside":
        text += hand_table("left")
    with pytest.raises(SetupError, match=said):
        read_description(text, "it")


def test_a_hand_that_is_not_there_is_told(pair: str) -> None:
    """With the names that there are; of a robot with one hand, that it has one; of one with two, that one is needed."""
    with pytest.raises(SetupError, match=r"unknown hand 'middle'\. Valid: left, right"):
        parts_for(f"{pair}@middle")
    with pytest.raises(SetupError, match="has one hand: there is no 'left'"):
        parts_for("mobile7@left")
    with pytest.raises(SetupError, match="has several hands, left, right: choose one with --hand"):
        check(pair, 1)
    assert isinstance(load_one("mobile4"), DescribedRobot)
