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
    """A position or rate that is not finite is a fault that says whose, and so is a time that is not finite."""
    robot = Robot()
    assert robot.tick() == ""
    assert robot.tick(positions={k: bad}) == f"The robot's feedback of {CHANNELS[k].moves} is not finite."
    assert robot.tick(rates={k: bad}) == f"The robot's feedback of {CHANNELS[k].name} is not finite."
    assert robot.tick(positions={0: complex(0.0, bad)}) == "The robot's feedback of the base's place is not finite."
    assert robot.tick(stamp=bad) == "The robot's feedback has no finite time."
    assert robot.tick() == ""


def test_finite_numbers_too_great_to_add_are_no_exception() -> None:
    """Readings of 1e308 are a fault, whatever their sum is; nothing is raised."""
    robot = Robot()
    robot.tick()
    assert robot.tick(positions={1: 1e308, 2: 1e308}).startswith("The robot's feedback of theta_1 is out of range")
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
    assert verdicts[first] == "The robot's feedback is frozen: its time has not advanced for 0.1 s."
    assert robot.tick() == ""
    again = [robot.tick(stamp=start + 0.0) for _ in range(25)]  # another number of the same value, each time
    assert again[-1] == verdicts[first]
    assert robot.tick() == ""
    backwards = [robot.tick(stamp=start - 0.001 * k) for k in range(25)]
    assert backwards[18] == ""
    assert backwards[-1] == verdicts[first]  # nor may it run backwards


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
    before = asked.lagged
    asked.move_to(12.0)  # back in time nothing moves
    assert asked.in_force == (7.0,)
    assert asked.lagged == before


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


def exactly(*channels: Channel) -> Feedback:
    return Feedback(channels)


def test_each_threshold_itself_is_still_fine() -> None:
    """What is just at a threshold, to the last bit, is no fault; these numbers are exact in binary."""
    joint = Channel("rate", "joint", "rad", 3.0, 20.0, -1.0, 1.5, resolution=0.25, dead_band=0.25)
    for place in (-1.0 - 0.05, 1.5 + 0.05):
        assert exactly(joint).check(0.0, [place], [0.0], 0.0) == ""
    for rate in (6.0, -6.0):
        assert exactly(joint).check(0.0, [0.0], [rate], 0.0) == ""
        assert "joint is out of range" in exactly(joint).check(0.0, [9.0], [rate], 0.0)  # and it is not the rate
    assert exactly(joint).check(0.0, [0.0], [0.0], 1.0) == ""
    assert exactly(joint).check(0.1, [0.0], [0.0], 0.0) == ""
    frozen = exactly(joint)
    assert frozen.check(0.0, [0.0], [0.0], 0.0) == ""
    assert frozen.check(0.0, [0.0], [0.0], 0.1) == ""
    assert "time has not advanced" in frozen.check(0.0, [0.0], [0.0], math.nextafter(0.1, 1.0))


def test_not_following_begins_past_its_threshold_and_its_time() -> None:
    """A rate that is off by the tolerance itself may be so for ever; one that is off by more, for 0.3 s."""
    joint = Channel("rate", "joint", "rad", 3.0, 20.0)
    past = exactly(joint)
    for rate in (0.2, -0.2):
        at = exactly(joint)
        for k in range(50):
            assert at.check(k / 10, [float(k)], [rate], k / 10) == ""
    assert past.check(0.0, [0.0], [0.25], 0.0) == ""
    assert past.check(0.3, [1.0], [0.25], 0.3) == ""
    assert "does not follow" in past.check(math.nextafter(0.3, 1.0), [2.0], [0.25], 0.3)


def steadily(dead_band: float, rate: float) -> Feedback:
    """Return a check that has seen `rate` asked for and done so long that its lag is over, to the last bit."""
    feedback = exactly(Channel("rate", "joint", "rad", 3.0, 20.0, resolution=0.25, dead_band=dead_band))
    feedback.asked.add((rate,), -64.0)
    feedback.check(-65.0, [-1.0], [0.0], -65.0)
    feedback.check(-0.25, [0.0], [rate], -0.25)
    assert feedback.asked.lagged == feedback.asked.in_force == (rate,)
    return feedback


def test_frozen_begins_past_three_steps() -> None:
    """A position that owes three steps of its resolution is not frozen; one that owes more is. Both directions."""
    for rate in (0.5, -0.5):
        feedback = steadily(0.25, rate)  # 0.125 a report: three steps of 0.25 after six
        assert feedback.check(0.0, [1.0], [rate], 0.0) == ""
        for k in range(1, 7):
            assert feedback.check(k / 4, [1.0], [rate], k / 4) == ""
        assert "joint does not change" in feedback.check(7 / 4, [1.0], [rate], 7 / 4)


def test_frozen_begins_past_its_time() -> None:
    """Whatever is owed, a position may stay for 0.1 s, to the last bit."""
    feedback = steadily(0.25, 3.0)
    feedback.asked.lagged = feedback.asked.in_force = (1e3,)
    assert feedback.check(0.0, [1.0], [3.0], 0.0) == ""
    assert feedback.check(0.1, [1.0], [3.0], 0.1) == ""
    feedback = steadily(0.25, 3.0)
    assert feedback.check(0.0, [1.0], [3.0], 0.0) == ""
    assert feedback.check(0.25, [1.0], [3.0], 0.25) == ""
    assert "joint does not change" in feedback.check(0.375, [1.0], [3.0], 0.375)


def test_at_the_edge_of_its_dead_band_a_robot_may_stand_still() -> None:
    """Asked for 1.5 dead bands to the last bit, it may stand still for ever."""
    for rate in (0.375, -0.375):
        feedback = steadily(0.25, rate)
        for k in range(200):
            assert feedback.check(k / 4, [1.0], [rate], k / 4) == ""


def test_a_change_of_any_kind_pays_what_is_owed() -> None:
    """A position that moves, however little and either way, owes nothing any more."""
    feedback = steadily(0.25, 0.5)
    for k in range(100):
        assert feedback.check(k / 4, [1.0 + 1e-15 * (k // 4 % 2)], [0.5], k / 4) == ""


def test_reports_must_have_every_channel() -> None:
    """A report with too few numbers is a mistake of the caller's, and raises."""
    with pytest.raises(ValueError, match="zip"):
        Robot().feedback.check(1.0, [0.0j, 0.0, 0.0], [0.0] * 4, 1.0)
    short = Asked(2)
    short.add((1.0,), 0.0)
    with pytest.raises(ValueError, match="zip"):
        short.move_to(1.0)
