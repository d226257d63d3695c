"""`python -m overreach.arm.spatial`: compile the arm's step, so that it can be had in a moment from then on.

Beside a robot that is driven: only with what time nobody else wants.
"""

from __future__ import annotations

import contextlib
import os

from overreach.arm.spatial.engine import warm

with contextlib.suppress(AttributeError, OSError):
    os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))
warm()
