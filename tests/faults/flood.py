"""`python -m tests.faults.flood ENDPOINT WHAT SECONDS RATE`: a process that asks a robot side, and never waits."""

from __future__ import annotations

import contextlib
import sys
import time

import zenoh

from overreach import __version__
from overreach.link.endpoint import open_session
from overreach.link.messages import PROTOCOL, Hello, encode, key
from overreach.requests import DisarmRequest, ResetRequest, StopRequest
from tests.said import said

MESSAGES = {
    "stop": ("stop", StopRequest()),
    "disarm": ("request", DisarmRequest(98)),
    "reset": ("request", ResetRequest()),
    "hello": ("hello", Hello(PROTOCOL, __version__)),
    "command": ("command", said(99, 2**50, 1, True, 0.4, 0.0)),
    "garbage": ("command", b"\xc1" * 4000),
}


def main() -> None:
    """Ask for SECONDS, RATE times a second, and print how often it did."""
    endpoint, what, seconds, rate = sys.argv[1:]
    name, message = MESSAGES[what]
    payload = message if isinstance(message, bytes) else encode(message)
    session = open_session(connect=endpoint)
    where = key("planar", name)
    begun = time.monotonic()
    count, due = 0, begun
    while (now := time.monotonic()) - begun < float(seconds):
        with contextlib.suppress(zenoh.ZError):
            if name == "command":
                session.put(where, payload, congestion_control=zenoh.CongestionControl.DROP)
            else:
                session.get(
                    where, lambda _: None, payload=payload, timeout=1.0,
                    congestion_control=zenoh.CongestionControl.DROP,
                )  # fmt: skip
        count += 1
        due += 1.0 / float(rate)
        if due > now:
            time.sleep(due - now)
    print(count, flush=True)
    session.close()  # type: ignore[no-untyped-call]  # zenoh's stub lacks the return type


main()
