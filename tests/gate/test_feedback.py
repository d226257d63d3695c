"""What a robot reports: each threshold is a number here, and each channel is tried alone, at a time that is not 0."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.gate.asked import Asked
from overreach.gate.feedback import Feedback, Position
from overreach.types import Channel

DT = 0.005
CHANNELS = (
    Channel("v_b", "the base's place", "m", 0.6, 3.5, resolution=0.002, dead_band=0.03),
    Channel("w_b", "the base's heading", "rad", 2.0, 12.0, resolution=0.002, dead_band=0.1),
    Channel("dtheta_1", "theta_1", "rad", 3.0, 20.0, -1.0, 1.5, resolution=0.002, dead_band=0.1),
    Channel("dlift", "lift", "m", 0.5, 2.0, 0.1, 0.9, resolution=0.002, dead_band=0.03),
)
starts = st.floats(1.0, 1e5)


class Robot:
    """A robot that does at once what it is asked, and a check of what it reports; what it reports can be altered."""

    def __init__(self, start: float = 123.4) -> None:
        self.feedback = Feedback(CHANNELS)
        self.t = start
        self.rates = [0.0] * 4
        self.place, self.heading, self.joint, self.lift = 0.3 + 0.1j, 0.2, 0.25, 0.5

    @property
    def positions(self) -> list[Position]:
        return [self.place, self.heading, self.joint, self.lift]

    def tick(
        self,
        asked: tuple[float, ...] = (0.0,) * 4,
        stamp: float | None = None,
        positions: dict[int, Position] | None = None,
        rates: dict[int, float] | None = None,
    ) -> str:
        """Report, be checked, be asked; `positions` and `rates` are reported instead of the true ones, by channel."""
        told = [(positions or {}).get(k, true) for k, true in enumerate(self.positions)]
        speed = [(rates or {}).get(k, true) for k, true in enumerate(self.rates)]
        verdict = self.feedback.check(self.t if stamp is None else stamp, told, speed, self.t)
        self.feedback.asked.add(asked, self.t)
        self.rates = list(asked)
        self.place += asked[0] * DT
        self.heading += asked[1] * DT
        self.joint += asked[2] * DT
        self.lift += asked[3] * DT
        self.t += DT
        return verdict


def alone(k: int, rate: float) -> tuple[float, ...]:
    return tuple(rate if i == k else 0.0 for i in range(4))


@given(starts)
def test_an_honest_robot_is_believed(start: float) -> None:
    """A robot that does what it is asked, at rest and moving, is never doubted."""
    robot = Robot(start)
    for k in range(200):
        assert robot.tick((0.4, -0.5, 1.0, -0.2) if 40 < k < 100 else (0.0,) * 4) == ""


@pytest.mark.parametrize("k", range(4))
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_named(k: int, bad: float) -> None:
    """A position or rate that is not finite is a fault that says whose, and so is a time."""
    robot = Robot()
    assert robot.tick() == ""
    assert robot.tick(positions={k: bad}) == f"The robot's feedback of {CHANNELS[k].moves} is not finite."
    assert robot.tick(rates={k: bad}) == f"The robot's feedback of {CHANNELS[k].name} is not finite."
    assert robot.tick(positions={0: complex(0.0, bad)}) == "The robot's feedback of the base's place is not finite."
    assert robot.tick(stamp=math.nan) == "The robot's feedback has no finite time."
    assert robot.tick() == ""


def test_finite_numbers_too_great_to_add_are_no_exception() -> None:
    """Readings of 1e308 are a fault, whatever their sum is; nothing is raised."""
    robot = Robot()
    robot.tick()
    assert robot.tick(positions={1: 1e308, 2: 1e308}).startswith("The robot's feedback")
    assert robot.tick(positions={2: -1e308}) == "The robot's feedback of theta_1 is out of range: -1e+308 rad."
    assert robot.tick(rates={0: 1e308}) == "The robot's feedback of v_b is out of range: 1e+308 m/s."


@pytest.mark.parametrize(
    ("k", "just", "beyond", "says"),
    [
        (2, 1.549, 1.551, "theta_1 is out of range: 1.551 rad"),
        (2, -1.049, -1.051, "theta_1 is out of range: -1.051 rad"),
        (3, 0.919, 0.921, "lift is out of range: 0.921 m"),
        (3, 0.081, 0.079, "lift is out of range: 0.079 m"),
    ],
)
def test_joints_out_of_range(k: int, just: float, beyond: float, says: str) -> None:
    """A joint may read up to 0.05 rad or 0.02 m past its limits, and no more; the base may be anywhere."""
    robot = Robot()
    robot.tick(positions={0: -1e6 + 1e6j, 1: 1e6})
    assert robot.tick(positions={k: just}) == ""
    assert robot.tick(positions={k: beyond}) == f"The robot's feedback of {says}."


@pytest.mark.parametrize(("k", "most"), [(0, 1.2), (1, 4.0), (2, 6.0), (3, 1.0)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rates_out_of_range(k: int, most: float, sign: float) -> None:
    """A rate that reads more than twice its limit is out of range, at once; up to there it may be a moment's."""
    robot = Robot()
    robot.tick()
    assert robot.tick(rates={k: 0.999 * sign * most}) == ""
    unit = CHANNELS[k].unit
    says = f"The robot's feedback of {CHANNELS[k].name} is out of range: {1.001 * sign * most:.4g} {unit}/s."
    assert robot.tick(rates={k: 1.001 * sign * most}) == says


@given(starts)
def test_a_time_that_stands_still_is_frozen_after_100_ms(start: float) -> None:
    """A report may be repeated for 100 ms; then feedback is frozen, until its time advances again."""
    robot = Robot(start)
    robot.tick()
    stamp = robot.t
    verdicts = [robot.tick(stamp=stamp) for _ in range(25)]
    first = next(k for k, verdict in enumerate(verdicts) if verdict)
    assert 20 <= first <= 21
    assert verdicts[first] == "The robot's feedback is frozen: its time has not advanced for 100 ms."
    assert robot.tick() == ""
    assert [robot.tick(stamp=start) for _ in range(25)][-1] == verdicts[first]  # nor may it run backwards


def test_a_time_that_is_not_now() -> None:
    """A report of up to 1 s ago or 0.1 s ahead is of now; others are of another time, and are not believed."""
    robot = Robot()
    robot.tick()
    assert robot.tick(stamp=robot.t + 0.099) == ""
    assert robot.tick(stamp=robot.t + 0.11) == "The robot's feedback is of another time: +0.11 s from now."
    assert robot.feedback.stamp < robot.t + 0.1
    late = Robot()
    assert late.tick(stamp=late.t - 0.999) == ""
    assert late.tick(stamp=late.t - 1.001) != ""
    older = Robot()
    assert older.tick(stamp=older.t - 1.001) == "The robot's feedback is of another time: -1 s from now."
    assert Robot().tick(stamp=-math.inf) == "The robot has reported nothing yet."


@pytest.mark.parametrize("k", range(4))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_position_that_stays_though_it_was_asked_to_move_is_frozen(k: int, sign: float) -> None:
    """A position that stays bit-identical is frozen once three times its resolution was asked of it."""
    robot = Robot()
    rate = sign * 0.2
    robot.tick(alone(k, rate))
    kept = robot.positions[k]
    verdicts = [robot.tick(alone(k, rate), positions={k: kept}) for _ in range(80)]
    first = next(i for i, verdict in enumerate(verdicts) if verdict)
    # Through the lag of 0.3 s, 0.2/s has moved 6 mm after t with 0.2 (t - 0.3 (1 - exp(-t/0.3))) = 0.006: 0.145 s.
    assert 0.144 <= (first + 1) * DT <= 0.155
    assert verdicts[first] == (
        f"The robot's feedback is frozen: {CHANNELS[k].moves} does not change, though it was asked to."
    )


def test_a_position_may_stand_still_for_100_ms() -> None:
    """However much is asked, 100 ms without a change are no fault; dead time of a motor is less."""
    robot = Robot()
    robot.tick(alone(2, 3.0))
    kept = robot.positions[2]
    verdicts = [robot.tick(alone(2, 3.0), positions={2: kept}, rates={2: 0.0}) for _ in range(30)]
    first = next(i for i, verdict in enumerate(verdicts) if verdict)
    assert 20 <= first <= 21


@pytest.mark.parametrize(("k", "band"), [(0, 0.03), (1, 0.1), (2, 0.1), (3, 0.03)])
def test_within_its_dead_band_a_robot_may_stand_still(k: int, band: float) -> None:
    """Asked for less than 1.5 dead bands it may stand still for ever; for more it may not."""
    robot = Robot()
    robot.tick()
    kept = robot.positions[k]
    for _ in range(2000):
        assert robot.tick(alone(k, 1.49 * band), positions={k: kept}, rates={k: 0.0}) == ""
    assert any("frozen" in robot.tick(alone(k, 1.6 * band), positions={k: kept}, rates={k: 0.0}) for _ in range(400))


@pytest.mark.parametrize(("k", "tolerance", "fast"), [(0, 0.1, 0.5), (1, 0.2, 2.0), (2, 0.2, 2.5), (3, 0.1, 0.5)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_not_following(k: int, tolerance: float, fast: float, sign: float) -> None:
    """0.1 m/s or 0.2 rad/s off, or 30 % where that is more, for 300 ms: it does not follow. At rest as well."""
    for asked, most in ((0.0, tolerance), (sign * fast, max(tolerance, 0.3 * fast))):
        for off in (most, -most):
            robot = Robot()

            def reads(rate: float, robot: Robot = robot, asked: float = asked) -> str:
                swaying = 0.5 + 0.01 * math.sin(robot.t)  # in range, and never the same
                return robot.tick(alone(k, asked), positions={k: swaying}, rates={k: rate})

            for _ in range(400):
                assert reads(asked) == ""
            for _ in range(200):
                assert reads(asked + 0.98 * off) == ""
            verdicts = [reads(asked + 1.02 * off) for _ in range(70)]
            first = next(i for i, verdict in enumerate(verdicts) if verdict)
            assert 0.295 <= first * DT <= 0.31
            assert verdicts[first] == (
                f"The robot does not follow: {CHANNELS[k].name} is {asked + 1.02 * off:.2g} "
                f"{CHANNELS[k].unit}/s, {asked:.2g} was asked for."
            )


def test_a_moment_is_no_fault() -> None:
    """A rate that comes back within 300 ms has its time anew: a spike every quarter of a second is followed."""
    robot = Robot()
    for k in range(1000):
        assert robot.tick(rates={0: 0.5 if k % 50 else 0.0}) == ""


@given(st.floats(0.0, 0.3), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
def test_any_lag_up_to_300_ms_follows(lag: float, first: float, then: float) -> None:
    """A base with a lag of 0 to 0.3 s that is asked for one speed and then another is never doubted."""
    robot = Robot()
    rate = 0.0
    for k in range(400):
        asked = first if k < 200 else then
        assert robot.tick(alone(0, asked), rates={0: rate}) == ""
        rate = asked + (rate - asked) * math.exp(-DT / lag) if lag > 1e-3 else asked


def test_after_a_reset_all_is_looked_at_anew_but_what_was_asked_is_known() -> None:
    """A reset forgives what was frozen or off; a base that is still coasting is not a fault for that."""
    robot = Robot()
    for _ in range(100):
        robot.tick(alone(0, 0.5))
    rate = 0.5
    for k in range(200):
        rate += -rate * DT / 0.3
        if k == 10:
            robot.feedback.reset()
        assert robot.tick(rates={0: rate}) == ""
    old = robot.t - 0.5
    robot.feedback.reset()
    assert robot.tick(stamp=old) == ""  # a clock that was set back is taken as it is
    robot.feedback.restart()
    assert robot.feedback.asked.in_force == (0.0,) * 4


def test_what_was_in_force_is_of_the_reports_own_time() -> None:
    """What is asked at t is in force after t, not at t; a late report is held against what was in force then."""
    asked = Asked(1)
    for k in range(100):
        asked.add((float(k),), 10.0 + k)
    for k in (3, 4, 7):
        asked.move_to(10.0 + k)
        assert asked.in_force == (k - 1.0,)
    asked.move_to(17.5)
    assert asked.in_force == (7.0,)
    asked.move_to(12.0)  # back in time nothing moves
    assert asked.in_force == (7.0,)


@given(st.lists(st.tuples(st.floats(0.001, 0.5), st.floats(-1, 1)), min_size=1, max_size=20), st.floats(0.0, 1.0))
def test_the_lag_is_first_order(steps: list[tuple[float, float]], late: float) -> None:
    """`lagged` solves dx/dt = (in_force - x)/0.3 exactly, however requests and reports interleave."""
    whole, pieces = Asked(1), Asked(1)
    whole.move_to(5.0)
    pieces.move_to(5.0)
    t, x, was = 5.0, 0.0, 0.0
    for lasts, rate in steps:
        for one in (whole, pieces):
            one.add((rate,), t)
        x, was = rate + (x - rate) * math.exp(-lasts / 0.3), rate
        pieces.move_to(t + 0.3 * lasts)
        t += lasts
    whole.move_to(t + late)
    pieces.move_to(t + late)
    x = was + (x - was) * math.exp(-late / 0.3)
    assert whole.lagged[0] == pytest.approx(x, abs=1e-9)
    assert pieces.lagged[0] == pytest.approx(x, abs=1e-9)
