"""The robot side's end of the link. Polled by the loop: no Python thread runs beside it.

Zenoh's ring channels keep the newest messages in Rust: what comes between two ticks costs the loop nothing until then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeVar, final

import msgspec
import zenoh
from zenoh.handlers import RingChannel

from overreach.link.endpoint import open_session
from overreach.link.messages import (
    ANY,
    LONGEST,
    Answer,
    AnyRequest,
    Hello,
    Refused,
    decode_command,
    decode_hello,
    decode_request,
    decode_stop,
    encode,
    key,
)
from overreach.types import Command

T = TypeVar("T")

NOT_UNDERSTOOD = (msgspec.DecodeError, UnicodeDecodeError, RecursionError)
"""What decoding may raise, for any bytes."""

HELD_MOST = 64
"""Messages of a kind that wait for the next ticks: of more than this at once the oldest are dropped."""
TAKEN_MOST = 8
"""Requests that are taken in one tick."""


@final
class RobotEnd:
    """Commands and requests for the robot called `name` in, its states out."""

    def __init__(self, listen: str, name: str) -> None:
        self.malformed = 0
        self.name = name
        self._session = open_session(listen=listen, seldom=[key(ANY, "request"), key(ANY, "hello")])
        self._commands = self._session.declare_subscriber(key(name, "command"), RingChannel(HELD_MOST))
        # Rings, which drop: a full one that waited would hold up whatever else comes on that connection.
        self._stops = self._session.declare_queryable(key(name, "stop"), RingChannel(1))
        self._requests = self._session.declare_queryable(key(name, "request"), RingChannel(HELD_MOST))
        self._hellos = self._session.declare_queryable(key(name, "hello"), RingChannel(HELD_MOST))
        self._states = self._session.declare_publisher(
            key(name, "state"),
            congestion_control=zenoh.CongestionControl.DROP,
            priority=zenoh.Priority.INTERACTIVE_HIGH,
            express=True,
        )

    def newest_command(self, operator: int = 0) -> Command | None:
        """Return the newest command of `operator` or, if there is none, of anybody since the last call, or None.

        So nobody else's can crowd out those of who drives. What does not decode is counted and dropped.
        """
        newest: Command | None = None
        for _ in range(HELD_MOST):
            sample = self._commands.try_recv()
            if sample is None:
                break
            try:
                command = decode_command(_short(sample.payload))
            except NOT_UNDERSTOOD:
                self.malformed += 1
                continue
            if newest is None or command.operator == operator or newest.operator != operator:
                newest = command
        return newest

    def requests(self) -> Iterator[tuple[AnyRequest, Callable[[Answer], None]]]:
        """Yield the newest stop and some of the waiting requests, each with the function that answers it."""
        yield from self._drain(self._stops, "stop", decode_stop, 1)
        yield from self._drain(self._requests, "request", decode_request)

    def hellos(self) -> Iterator[tuple[Hello, Callable[[Answer | msgspec.Raw], None]]]:
        """Yield some of the waiting hellos, each with the function that answers it, by a message or an encoded one."""
        yield from self._drain(self._hellos, "hello", decode_hello)

    def _drain(
        self, queryable: zenoh.Queryable[Any], what: str, decode: Callable[[bytes], T], most: int = TAKEN_MOST
    ) -> Iterator[tuple[T, Callable[[Answer | msgspec.Raw], None]]]:
        for _ in range(most):
            query = queryable.try_recv()
            if query is None:
                return
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
