"""`python -m overreach.host ROBOT PERIOD ASKS REPORTS DOOR READY`: the process of a host. Started by `hosted` alone."""

from __future__ import annotations

import contextlib
import gc
import os
import pickle
import signal
import sys
import threading
import traceback

from overreach.clock import MonotonicClock
from overreach.errors import OverreachError, told
from overreach.host.mailbox import Mailbox
from overreach.host.records import Made
from overreach.host.serve import Host
from overreach.priority import HOST, real_time
from overreach.robots.load import load_robot

END_S = 1.2
"""Without a loop the host ends after this long [s], though the robot's driver hangs."""
LOOK_S = 0.1


def end_without(parent: int) -> None:
    """End this process END_S [s] after `parent` has ended, whatever hangs."""
    clock = MonotonicClock()
    while os.getppid() == parent:
        clock.sleep_until(clock.now() + LOOK_S)
    clock.sleep_until(clock.now() + END_S)
    os._exit(1)


def main() -> None:
    """Make the robot, tell the loop what it is, and serve it."""
    name, period, *descriptors = sys.argv[1:]
    asks, reports, door, ready = map(int, descriptors)
    # Who ends the loop ends the host: a signal to both leaves the robot to the loop's own ramp.
    for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(each, signal.SIG_IGN)
    threading.Thread(target=end_without, args=(os.getppid(),), daemon=True).start()
    clock = MonotonicClock()
    host: Host | None = None
    try:
        robot = load_robot(name, clock.now())
        answer = pickle.dumps(Made(robot.model, bool(robot.simulated)))
        host = Host(robot, float(period), clock, Mailbox(asks), Mailbox(reports), door)
    except OverreachError as error:
        answer = pickle.dumps(Made(None, False, str(error)))
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        traceback.print_exc()
        wrong = f"the robot {name!r} could not be made, or its model not pickled ({told(error)}): try --no-hosted"
        answer = pickle.dumps(Made(None, False, wrong))
    real_time(HOST)
    gc.collect()
    gc.freeze()
    with contextlib.suppress(BrokenPipeError), open(ready, "wb") as pipe:
        pipe.write(answer)
    if host is not None:
        host.run()


main()
