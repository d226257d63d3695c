"""The robot side's end of the link. Polled by the loop: no thread of Python's runs beside it.

Zenoh's ring channel of one keeps the newest stick in Rust, so that latest wins costs the loop nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeVar, final

import msgspec
import zenoh
from zenoh.handlers import FifoChannel, RingChannel

from overreach.link.endpoint import open_session
from overreach.link.messages import (
    KEY_HELLO,
    KEY_REQUEST,
    KEY_STATE,
    KEY_STICK,
    LONGEST,
    Answer,
    Hello,
    Refused,
    Request,
    State,
    decode_hello,
    decode_request,
    decode_stick,
    encode,
)
from overreach.types import Stick

T = TypeVar("T")

NOT_UNDERSTOOD = (msgspec.DecodeError, UnicodeDecodeError, RecursionError)
"""What decoding may raise, whatever bytes came."""

REQUESTS_HELD = 64
"""Requests that wait for the next tick; more than this at once are not waited for."""


@final
class RobotEnd:
    """Sticks and requests in, states out."""

    def __init__(self, listen: str) -> None:
        self.malformed = 0
        self._session = open_session(listen=listen)
        self._sticks = self._session.declare_subscriber(KEY_STICK, RingChannel(1))
        self._requests = self._session.declare_queryable(KEY_REQUEST, FifoChannel(REQUESTS_HELD))
        self._hellos = self._session.declare_queryable(KEY_HELLO, FifoChannel(REQUESTS_HELD))
        self._states = self._session.declare_publisher(
            KEY_STATE,
            congestion_control=zenoh.CongestionControl.DROP,
            priority=zenoh.Priority.INTERACTIVE_HIGH,
            express=True,
        )

    def newest_stick(self) -> Stick | None:
        """Return the newest stick since the last call, or None. What does not decode is counted and dropped."""
        sample = self._sticks.try_recv()
        if sample is None:
            return None
        try:
            return decode_stick(_short(sample.payload))
        except NOT_UNDERSTOOD:
            self.malformed += 1
            return None

    def requests(self) -> Iterator[tuple[Request, Callable[[Answer], None]]]:
        """Yield each waiting request with the function that answers it."""
        yield from self._drain(self._requests, decode_request)

    def hellos(self) -> Iterator[tuple[Hello, Callable[[Answer], None]]]:
        """Yield each waiting hello with the function that answers it."""
        yield from self._drain(self._hellos, decode_hello)

    def _drain(
        self, queryable: zenoh.Queryable[Any], decode: Callable[[bytes], T]
    ) -> Iterator[tuple[T, Callable[[Answer], None]]]:
        while (query := queryable.try_recv()) is not None:
            answer = _answer_to(query)
            try:
                message = decode(_short(query.payload) if query.payload else b"")
            except NOT_UNDERSTOOD as error:
                self.malformed += 1
                answer(Refused(f"Not understood: {error}"))
                continue
            yield message, answer

    def publish(self, state: State) -> None:
        """Send `state`; dropped where the network is full."""
        self._states.put(encode(state))

    def close(self) -> None:
        """Close the session; without this the process could hang at its end."""
        self._session.close()  # type: ignore[no-untyped-call]  # zenoh's stub lacks the return type


def _short(payload: zenoh.ZBytes) -> bytes:
    if len(payload) > LONGEST:
        raise msgspec.DecodeError(f"a message of more than {LONGEST} bytes")
    return payload.to_bytes()


def _answer_to(query: zenoh.Query) -> Callable[[Answer], None]:
    def answer(message: Answer) -> None:
        query.reply(query.key_expr, encode(message))
        query.drop()  # type: ignore[no-untyped-call]  # zenoh's stub lacks the return type

    return answer
