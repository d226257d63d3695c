from __future__ import annotations

import pytest

from overreach.gate.stop import StopLatch


def armed() -> StopLatch:
    latch = StopLatch()
    latch.arm(7, 3)
    return latch


def test_a_new_latch_is_disarmed_and_nobodys() -> None:
    """At the start nothing is latched, nobody has armed, and no press is spent."""
    latch = StopLatch()
    assert (latch.stopped, latch.fault, latch.armed, latch.latched) == (False, "", False, False)
    assert (latch.operator, latch.spent_grip, latch.paused) == (0, 0, False)


def test_arming_notes_who_and_which_press() -> None:
    """Who arms is noted, with the press up to which nothing counts; a later spending only adds to it."""
    latch = armed()
    assert (latch.armed, latch.operator, latch.spent_grip) == (True, 7, 3)
    latch.spend(5)
    assert latch.spent_grip == 5
    latch.spend(4)
    assert latch.spent_grip == 5


@pytest.mark.parametrize("act", ["stop", "fail", "disarm", "reset"])
def test_whatever_ends_motion_disarms(act: str) -> None:
    """Stop, fault, disarm and reset each leave the robot disarmed."""
    latch = armed()
    getattr(latch, act)(*(("why",) if act == "fail" else ()))
    assert not latch.armed
    assert latch.latched is (act in ("stop", "fail"))
    assert latch.stopped is (act == "stop")


def test_only_a_reset_unlatches() -> None:
    """Stopped, faulted or both: arming does nothing until a reset, which releases both and arms nothing."""
    for acts in (("stop",), ("fail",), ("stop", "fail")):
        latch = armed()
        for act in acts:
            getattr(latch, act)(*(("why",) if act == "fail" else ()))
        assert latch.latched
        latch.arm(8, 9)
        assert (latch.armed, latch.operator) == (False, 7)
        latch.reset()
        assert (latch.latched, latch.stopped, latch.fault, latch.armed) == (False, False, "", False)
        latch.arm(8, 9)
        assert (latch.armed, latch.operator, latch.spent_grip) == (True, 8, 9)


def test_a_pause_lasts_until_somebody_arms() -> None:
    """A pause disarms, but latches nothing: arming alone leads on; disarming and a reset do not."""
    latch = armed()
    latch.pause()
    assert (latch.paused, latch.armed, latch.latched) == (True, False, False)
    latch.disarm()
    latch.reset()
    assert latch.paused
    latch.arm(7, 4)
    assert (latch.paused, latch.armed) == (False, True)


def test_the_first_fault_stays() -> None:
    """A fault keeps its first reason until a reset."""
    latch = StopLatch()
    latch.fail("first")
    latch.fail("second")
    assert latch.fault == "first"
    latch.reset()
    latch.fail("second")
    assert latch.fault == "second"
