"""The robot side's end of the link. Polled by the loop: no Python thread runs beside it.

Zenoh's ring channel of one keeps the newest command in Rust, so that latest wins costs the loop nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeVar, final

import msgspec
import zenoh
from zenoh.handlers import FifoChannel, RingChannel

from overreach.link.endpoint import open_session
from overreach.link.messages import (
    LONGEST,
    Answer,
    AnyRequest,
    Hello,
    Refused,
    decode_command,
    decode_hello,
    decode_request,
    encode,
    key,
)
from overreach.types import Command

T = TypeVar("T")

NOT_UNDERSTOOD = (msgspec.DecodeError, UnicodeDecodeError, RecursionError)
"""What decoding may raise, for any bytes."""

REQUESTS_HELD = 64
"""Requests that wait for the next tick; more than this at once are not waited for."""


@final
class RobotEnd:
    """Commands and requests for the robot called `name` in, its states out."""

    def __init__(self, listen: str, name: str) -> None:
        self.malformed = 0
        self.name = name
        self._session = open_session(listen=listen)
        self._commands = self._session.declare_subscriber(key(name, "command"), RingChannel(1))
        self._requests = self._session.declare_queryable(key(name, "request"), FifoChannel(REQUESTS_HELD))
        self._hellos = self._session.declare_queryable(key(name, "hello"), FifoChannel(REQUESTS_HELD))
        self._states = self._session.declare_publisher(
            key(name, "state"),
            congestion_control=zenoh.CongestionControl.DROP,
            priority=zenoh.Priority.INTERACTIVE_HIGH,
            express=True,
        )

    def newest_command(self) -> Command | None:
        """Return the newest command since the last call, or None. What does not decode is counted and dropped."""
        sample = self._commands.try_recv()
        if sample is None:
            return None
        try:
            return decode_command(_short(sample.payload))
        except NOT_UNDERSTOOD:
            self.malformed += 1
            return None

    def requests(self) -> Iterator[tuple[AnyRequest, Callable[[Answer], None]]]:
        """Yield each waiting request with the function that answers it."""
        yield from self._drain(self._requests, "request", decode_request)

    def hellos(self) -> Iterator[tuple[Hello, Callable[[Answer | msgspec.Raw], None]]]:
        """Yield each waiting hello with the function that answers it, with a message or one that is encoded."""
        yield from self._drain(self._hellos, "hello", decode_hello)

    def _drain(
        self, queryable: zenoh.Queryable[Any], what: str, decode: Callable[[bytes], T]
    ) -> Iterator[tuple[T, Callable[[Answer | msgspec.Raw], None]]]:
        while (query := queryable.try_recv()) is not None:
            answer = _answer_to(query, key(self.name, what))
            try:
                message = decode(_short(query.payload) if query.payload else b"")
            except NOT_UNDERSTOOD as error:
                self.malformed += 1
                answer(Refused(f"Not understood: {error}"))
                continue
            yield message, answer

    def publish(self, state: bytes) -> None:
        """Send an encoded state; dropped where the network is full."""
        self._states.put(state)

    def close(self) -> None:
        """Close the session; without this the process could hang at its end."""
        self._session.close()  # type: ignore[no-untyped-call]  # zenoh's stub lacks the return type


def _short(payload: zenoh.ZBytes) -> bytes:
    if len(payload) > LONGEST:
        raise msgspec.DecodeError(f"a message of more than {LONGEST} bytes")
    return payload.to_bytes()


def _answer_to(query: zenoh.Query, own: str) -> Callable[[Answer | msgspec.Raw], None]:
    def answer(message: Answer | msgspec.Raw) -> None:
        query.reply(own, encode(message))  # under its own key: a hello may be for any robot
        query.drop()  # type: ignore[no-untyped-call]  # zenoh's stub lacks the return type

    return answer
