"""`python -m tests.faults.beside SECONDS`: a bare loop in real time, and how late it is, second by second [ms].

The machine's own part: it keeps time as the robot side does, at the same rate and above its priority, and does no more.
"""

from __future__ import annotations

import json
import sys
import time

import numpy as np

from overreach.clock import MonotonicClock
from overreach.priority import HOST, real_time

PERIOD_S = 0.005


def main() -> None:
    """Keep time for SECONDS; print a list of (p99, greatest lateness), one for each second."""
    real_time(HOST)
    clock = MonotonicClock(0.0004)
    due = clock.now()
    end, late = due + float(sys.argv[1]), []
    while due < end:
        due += PERIOD_S
        clock.sleep_until(due)
        late.append((time.monotonic() - due) * 1e3)
        due += int(late[-1] / 1e3 / PERIOD_S) * PERIOD_S
    second = round(1.0 / PERIOD_S)
    parts = [late[k : k + second] for k in range(0, len(late) - second // 2, second)]
    print(json.dumps([(float(np.quantile(part, 0.99)), max(part)) for part in parts]))


main()
