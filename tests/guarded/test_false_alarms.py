"""An honest robot that is not ideal is believed: no fault in an hour of driving."""

from __future__ import annotations

import random

import pytest

from overreach.robots.imperfect import Imperfection
from overreach.verdicts import Verdict
from tests.reached import Reached
from tests.side import Side

HOUR_S = 3600
RATE_HZ = 50.0
"""The slowest loop there is: the most time between looks."""
HONEST = {
    "lag of 0.3 s": Imperfection(lag_s=0.3),
    "base lag of 0.3 s": Imperfection(base_lag_s=0.3),
    "noise": Imperfection(noise=0.005, rate_noise=0.02, seed=7),
    "dead band of 3 cm/s and 6 deg/s": Imperfection(dead_band=(0.03, 0.105)),
    "3 % too fast": Imperfection(gain=1.03),
    "feedback at 25 Hz": Imperfection(feedback_s=0.04),
    "all at once": Imperfection(
        lag_s=0.05, base_lag_s=0.15, noise=0.002, rate_noise=0.01, seed=7, dead_band=(0.03, 0.105), gain=0.97,
        feedback_s=0.04, feedback_delay_s=0.03,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", HONEST)
def test_no_false_alarm_in_an_hour(name: str, reached: Reached) -> None:
    """In an hour of random driving, letting go and pressing again, a robot that is only imperfect is never a fault."""
    chance = random.Random(name)
    side = Side(start=chance.uniform(1.0, 1e4), dt=1.0 / RATE_HZ, imperfection=HONEST[name])
    side.arm()
    seconds = reached.times(HOUR_S)
    end = side.now + seconds
    went = 0.0
    while side.now < end:
        size = chance.choice((0.4, 0.4, 0.1, 0.03))
        side.held = chance.random() < 0.8
        side.grip += not side.held
        step = side.drive(chance.uniform(0.1, 6.0), chance.uniform(-size, size), chance.uniform(-size, size))
        went = max(went, abs(step.split.v_b))
        assert step.verdict is not Verdict.FAULT, f"{side.now - end + seconds:.2f} s: {step.fault}"
    side.check()
    assert went > 0.3  # it did drive
    reached.say("feedback NaN, out of range, biased, frozen, not following", f"{name}: 0 false alarms in {seconds} s")
