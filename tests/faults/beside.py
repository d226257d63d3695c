"""`python -m tests.faults.beside SECONDS`: a bare loop in real time, and how late it was at most [ms].

The machine's own part: it keeps time as the robot side does, at the same rate and above its priority, and does no more.
"""

from __future__ import annotations

import sys
import time

from overreach.clock import MonotonicClock
from overreach.priority import HOST, real_time

PERIOD_S = 0.005


def main() -> None:
    """Keep time for SECONDS; print the greatest lateness."""
    real_time(HOST)
    clock = MonotonicClock(0.0004)
    due = clock.now()
    end, worst = due + float(sys.argv[1]), 0.0
    while due < end:
        due += PERIOD_S
        clock.sleep_until(due)
        late = time.monotonic() - due
        worst = max(worst, late)
        due += int(late / PERIOD_S) * PERIOD_S
    print(f"{worst * 1e3:.1f}")


main()
