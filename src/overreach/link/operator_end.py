"""The operator side's end of the link: sticks and requests up, states down."""

from __future__ import annotations

from collections.abc import Callable
from typing import final

import zenoh

from overreach import __version__
from overreach.clock import MonotonicClock
from overreach.errors import LinkError
from overreach.link.endpoint import open_session
from overreach.link.messages import (
    KEY_HELLO,
    KEY_REQUEST,
    KEY_STATE,
    KEY_STICK,
    PROTOCOL,
    Accepted,
    Answer,
    Configure,
    Hello,
    Refused,
    Request,
    State,
    Welcome,
    decode_answer,
    decode_state,
    encode,
)
from overreach.types import Stick

ANSWER_S = 1.0
"""How long an answer is waited for [s]."""
LOADING_S = 10.0
"""How long new settings may take [s]: a law that is used for the first time has its libraries loaded first."""
AGAIN_S = 0.02


@final
class OperatorEnd:
    """A session to one robot side. Callbacks come on zenoh's thread."""

    def __init__(self, connect: str) -> None:
        self.endpoint = connect
        self._session = open_session(connect=connect)
        self._sticks = self._session.declare_publisher(
            KEY_STICK,
            congestion_control=zenoh.CongestionControl.DROP,
            priority=zenoh.Priority.INTERACTIVE_HIGH,
            express=True,
        )
        self._states: zenoh.Subscriber[None] | None = None

    def subscribe(self, on_state: Callable[[State], None]) -> None:
        """Call `on_state` with every state that comes."""

        def receive(sample: zenoh.Sample) -> None:
            on_state(decode_state(sample.payload.to_bytes()))

        self._states = self._session.declare_subscriber(KEY_STATE, receive)

    def send(self, stick: Stick) -> None:
        """Send a stick; dropped where the network is full (the next one says the same and more)."""
        self._sticks.put(encode(stick))

    def _ask(self, key: str, message: object, timeout_s: float) -> Answer | None:
        replies = self._session.get(
            key,
            payload=encode(message),
            timeout=timeout_s,
            congestion_control=zenoh.CongestionControl.BLOCK,
            express=True,
        )
        for reply in replies:
            if reply.ok is not None:
                answer: Answer = decode_answer(reply.ok.payload.to_bytes())
                return answer
        return None

    def request(self, request: Request) -> Accepted | Refused:
        """Ask the robot side for something and return its answer. Blocks for at most ANSWER_S, settings LOADING_S."""
        answer = self._ask(KEY_REQUEST, request, LOADING_S if isinstance(request, Configure) else ANSWER_S)
        if isinstance(answer, Accepted | Refused):
            return answer
        return Refused("No answer from the robot side.")

    def welcome(self, wait_s: float, ended: Callable[[], bool] = lambda: False) -> Welcome:
        """Say hello until the robot side answers.

        Raises LinkError after `wait_s` [s], where `ended()` says that it never will, or where it does not fit.
        """
        clock = MonotonicClock()
        until = clock.now() + wait_s
        while True:
            answer = self._ask(KEY_HELLO, Hello(PROTOCOL, __version__), 0.5)
            if isinstance(answer, Welcome):
                return answer
            if isinstance(answer, Refused):
                raise LinkError(answer.reason)
            if ended():
                raise LinkError("the robot side has ended before it was ready (see above)")
            if clock.now() > until:
                raise LinkError(
                    f"no robot side answers at {self.endpoint}: "
                    f"start it with `overreach robot --listen {self.endpoint}`"
                )
            clock.sleep_until(clock.now() + AGAIN_S)

    def close(self) -> None:
        """Close the session; without this the process could hang at its end."""
        self._session.close()  # type: ignore[no-untyped-call]  # zenoh's stub lacks the return type
