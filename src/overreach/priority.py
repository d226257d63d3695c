"""Real-time priority, where the machine permits it."""

from __future__ import annotations

import os

LOOP = 20
"""Above ordinary threads, below the kernel's own."""
HOST = 21
"""Above the loop: a law that never returns does not keep the robot's host from ramping, on a single core either."""


def real_time(priority: int) -> bool:
    """Ask for SCHED_FIFO for this thread; say whether it was permitted. Linux only."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(priority))
    except (AttributeError, OSError):
        return False
    return True
