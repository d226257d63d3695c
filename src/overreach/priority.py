"""Real-time priority, where the machine permits it."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator

LOOP = 20
"""Above ordinary threads, below the kernel's own."""
HOST = 21
"""Above the loop: a law that never returns does not keep the robot's host from ramping, on a single core either."""


EAGER = -20
"""Ahead of all ordinary threads."""
AUTOGROUP = "/proc/self/autogroup"


@contextlib.contextmanager
def eager() -> Iterator[None]:
    """Ask that threads that this one starts in the block go ahead of ordinary ones, in order to share locks with it.

    Otherwise a loop in real time waits, for the network library's lock, until a busy machine lets its holder go on.
    Where the kernel groups threads by their terminals, priorities count only within a group: for as long as the block
    lasts, this one's group goes ahead as well.
    """
    with contextlib.suppress(AttributeError, OSError):
        os.setpriority(os.PRIO_PROCESS, 0, EAGER)
    before = _group(EAGER)
    try:
        yield
    finally:
        if before is not None and before != EAGER:  # else it is not ours to put back
            _group(before)


def _group(nice: int) -> int | None:
    """Give this process's group a priority; return the one that it had, None where there is no group or no right."""
    with contextlib.suppress(OSError, ValueError, IndexError), open(AUTOGROUP, "r+", encoding="ascii") as group:
        before = int(group.read().split()[-1])
        group.seek(0)
        group.write(str(nice))
        return before
    return None


def real_time(priority: int) -> bool:
    """Ask for SCHED_FIFO for this thread, not for those that it starts; say whether it was permitted. Linux only."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(priority))
    except (AttributeError, OSError):
        return False
    return True
