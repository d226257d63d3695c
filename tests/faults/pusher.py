"""`python -m tests.faults.pusher ENDPOINT`: an operator who arms, pushes, and does what it is told on its input.

hold, release, press, arm, reset: as they say; stop: asks for a stop and prints how long the answer took [s].
"""

from __future__ import annotations

import sys
import threading
import time

from overreach.link.operator_end import OperatorEnd
from overreach.requests import ArmRequest, ResetRequest, StopRequest
from tests.processes import GENEROUS_S, Driver, until


def main() -> None:
    """Push until the input ends."""
    link = OperatorEnd(sys.argv[1])
    link.welcome(GENEROUS_S)
    link.subscribe(lambda _: None)
    until(lambda: link.t is not None, what="a state")
    driver = Driver(link)
    link.request(ArmRequest(driver.operator))
    driver.grip = 1
    holds = [True]

    def push() -> None:
        while True:
            driver.send(held=holds[0])
            time.sleep(1 / 60)

    threading.Thread(target=push, daemon=True).start()
    print("pushes", flush=True)
    for line in sys.stdin:
        word = line.strip()
        if word == "release":
            holds[0] = False
        elif word == "press":
            driver.grip += 1
            holds[0] = True
        elif word == "arm":
            link.request(ArmRequest(driver.operator, driver.grip))
        elif word == "reset":
            link.request(ResetRequest())
        elif word == "stop":
            begun = time.monotonic()
            answer = link.request(StopRequest())
            print(f"{type(answer).__name__} {time.monotonic() - begun}", flush=True)
        if word != "stop":
            print(word, flush=True)
    link.close()


main()
