"""How many pictures are on their way to a page."""

from __future__ import annotations

from collections import deque

import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.cockpit.visitor import PICTURES_MOST, Window

PERIOD_S = 1 / 60


def ages(
    rate: float, delay: float, seconds: float, stall: tuple[float, float] = (0.0, 0.0)
) -> list[tuple[float, float]]:
    """Send pictures through a link of `rate` [pictures/s] and `delay` [s] each way; return (time, age of what is seen).

    stall: from when until when nothing passes [s].
    """
    window = Window()
    coming: deque[tuple[float, int, float]] = deque()  # when it comes, which, of when
    told: deque[tuple[float, int]] = deque()
    free, seen, found = 0.0, 0.0, []
    for n in range(int(seconds / PERIOD_S)):
        now = n * PERIOD_S
        while coming and coming[0][0] <= now:
            came, which, seen = coming.popleft()
            told.append((came + delay, which))
        while told and told[0][0] <= now:
            window.shown(told.popleft()[1], now)
        if window.open:
            window.sent(n, now)
            free = max(free, now) + 1 / rate
            if stall[0] <= free < stall[1]:
                free = stall[1]
            coming.append((free + delay, n, now))
        assert len(coming) + len(told) <= PICTURES_MOST
        found.append((now, now - seen))
    return found


@given(rate=st.floats(4.0, 1e4), delay=st.floats(0.0, 0.1))
def test_pictures_do_not_queue_up(rate: float, delay: float) -> None:
    """Once the window has settled, what is seen is older than the link makes it by less than 0.25 s and one picture."""
    least = delay + 1 / rate
    settled = [age for now, age in ages(rate, delay, 30.0) if now > 5.0]
    assert max(settled) <= 2 * least + delay + 0.25 + PERIOD_S


@pytest.mark.parametrize("delay", [0.0, 0.09, 0.125])
def test_a_stall_is_forgotten(delay: float) -> None:
    """After a stall of 0.6 s in a link with any delay the window opens again: pictures are as new as before."""
    found = ages(1e4, delay, 40.0, (10.0, 10.6))
    before = max(age for now, age in found if 2.0 < now < 9.9)
    after = max(age for now, age in found if now > 25.0)
    assert after <= before + PERIOD_S
