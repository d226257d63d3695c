"""The robot side as a process: real-time set-up, signals, and the loop."""

from __future__ import annotations

import contextlib
import gc
import os
import signal
import sys
from types import FrameType

from overreach.arm.chain import governs
from overreach.arm.spatial.engine import warm_beside
from overreach.clock import Clock, MonotonicClock
from overreach.errors import SetupError
from overreach.gate.gate import MAX_DELAY_S, check_delay
from overreach.host.hosted import Hosted
from overreach.link.endpoint import check_endpoint
from overreach.link.messages import Choice, check_name
from overreach.link.robot_end import RobotEnd
from overreach.priority import LOOP, eager, real_time
from overreach.robot_side.loop import USUAL, Loop
from overreach.robots.base import Robot
from overreach.robots.load import check_robot_name, load_robot

RATES = (50.0, 1000.0)
"""Valid loop rates [Hz]."""
PARENT_LOOK_S = 0.1
SPIN_S = 0.0004
"""The loop wakes this long [s] before its time and polls the clock until then: 8 % of a core at 200 Hz ..."""
SPIN_PART = 0.1
"""... and never more than this part of a period."""


def check_rate(rate: float) -> None:
    """Raise SetupError unless `rate` [Hz] is one the loop can run at."""
    if not RATES[0] <= rate <= RATES[1]:
        raise SetupError(f"--rate must be {RATES[0]:g} to {RATES[1]:g} Hz, got {rate:g}")


def run_robot(
    robot: str,
    listen: str,
    rate: float,
    parent: int | None = None,
    name: str = "",
    law: Choice = USUAL,
    hosted: bool = True,
    max_delay: float = MAX_DELAY_S,
) -> None:
    """Run the robot side until SIGINT, SIGTERM or SIGHUP or, with `parent`, until that process has ended.

    Each of these ramps the robot to zero. name: its name in the network, by default the robot's own; hosted: whether
    the robot runs in a process of its own, which ramps by itself when this one is held up, hangs or dies;
    max_delay [s]: how old a command may be. Raises SetupError or LinkError before anything moves.
    """
    check_rate(rate)
    check_delay(max_delay)
    endpoint = check_endpoint(listen)
    if name:
        check_name(name)
    clock = MonotonicClock(min(SPIN_S, SPIN_PART / rate))
    ended = False

    def end(_signal: int, _frame: FrameType | None) -> None:
        nonlocal ended
        ended = True

    for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if each is not signal.SIGHUP or signal.getsignal(each) is not signal.SIG_IGN:  # as `nohup` leaves it
            signal.signal(each, end)
    check_robot_name(robot)
    with contextlib.ExitStack() as left:
        device: Robot
        if hosted:
            try:
                device = Hosted(robot, 1.0 / rate, clock, lambda: ended)
            except SetupError:
                if ended:  # while the robot was made
                    return
                raise
            left.callback(device.close)
        else:
            device = load_robot(robot, clock.now())
            left.callback(_stop, device, clock)  # whatever comes in between, also before the first tick
        left.enter_context(eager())
        link = RobotEnd(endpoint, name or check_name(device.model.name))
        left.callback(link.close)
        loop = Loop(device, link, clock, rate, law, max_delay)
        fifo = real_time(LOOP)
        if parent is None:
            note = "" if fifo else " (no real-time priority: see `overreach doctor`)"
            print(f"overreach robot: {link.name} listens at {endpoint}, {rate:g} Hz{note}", file=sys.stderr)
        look = clock.now()

        def running() -> bool:
            nonlocal look
            if parent is not None and clock.now() >= look:
                look = clock.now() + PARENT_LOOK_S
                return os.getppid() == parent and not ended
            return not ended

        gc.collect()
        gc.freeze()
        if governs(device.model.arm):
            warm_beside()
        loop.run(running)


def _stop(device: Robot, clock: Clock) -> None:
    with contextlib.suppress(Exception):
        device.stop(clock.now())
