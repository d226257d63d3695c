"""Real-time priority, where the machine permits it."""

from __future__ import annotations

import contextlib
import os

LOOP = 20
"""Above ordinary threads, below the kernel's own."""
HOST = 21
"""Above the loop: a law that never returns does not keep the robot's host from ramping, on a single core either."""


EAGER = -20
"""Ahead of all ordinary threads."""


def eager() -> None:
    """Ask that the threads that this one starts from now on go ahead of ordinary ones, in order to share locks with it.

    Otherwise a loop in real time waits, for the network library's lock, until a busy machine lets its holder go on.
    """
    with contextlib.suppress(AttributeError, OSError):
        os.setpriority(os.PRIO_PROCESS, 0, EAGER)


def real_time(priority: int) -> bool:
    """Ask for SCHED_FIFO for this thread, not for those that it starts; say whether it was permitted. Linux only."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(priority))
    except (AttributeError, OSError):
        return False
    return True
