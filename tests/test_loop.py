from __future__ import annotations

import pytest

from overreach.clock import SteppedClock
from overreach.link.endpoint import free_port
from overreach.link.robot_end import RobotEnd
from overreach.loop import Loop
from overreach.model.planar import load_planar
from overreach.robots.kinematic import KinematicRobot

PERIOD = 0.005


@pytest.mark.parametrize("late", [0.0123, 0.0049, 1.0])
def test_an_overrun_is_counted_and_never_made_up_for(late: float) -> None:
    """After a stall the loop leaves out what it has missed: no two ticks in one period, all on the beat."""
    start = 100.0
    clock = SteppedClock(start)
    model = load_planar()
    link = RobotEnd(f"tcp/127.0.0.1:{free_port()}")
    try:
        loop = Loop(model, KinematicRobot(model, now=start), link, clock, 1.0 / PERIOD)
        ticks: list[float] = []
        whole = loop.tick

        def tick(now: float, dt: float) -> None:
            ticks.append(now)
            whole(now, dt)
            if len(ticks) == 10:
                clock.t += late  # the machine stalls in the middle of a tick

        loop.tick = tick  # type: ignore[method-assign]  # the real tick, and a note of when it was
        loop.run(lambda: len(ticks) < 30)
    finally:
        link.close()
    periods = [round((at - start) / PERIOD, 6) for at in ticks]
    slots = [int(period) for period in periods]
    assert len(set(slots)) == len(slots)
    assert periods == [float(slot) for slot in slots]  # always on the beat
    assert loop.overruns == slots[-1] - len(slots)
    assert loop.overruns == int(late / PERIOD)
