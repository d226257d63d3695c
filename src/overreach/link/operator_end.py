"""The operator side's end of the link: sticks and requests up, states down."""

from __future__ import annotations

import contextlib
import queue
import threading
from collections.abc import Callable
from typing import TypeAlias, final

import msgspec
import zenoh

from overreach import __version__
from overreach.clock import MonotonicClock
from overreach.errors import LinkError
from overreach.link.endpoint import open_session
from overreach.link.messages import (
    ANY,
    PROTOCOL,
    Accepted,
    Answer,
    AnyRequest,
    ConfigureRequest,
    Hello,
    Refused,
    State,
    Welcome,
    decode_answer,
    decode_state,
    encode,
    key,
)
from overreach.link.pace import Pace
from overreach.requests import DisarmRequest, StopRequest
from overreach.types import Command

ANSWER_S = 1.2
"""How long to wait for an answer [s] ..."""
PATIENCE_S = 0.4
"""... and after how long to ask again: a busy robot side takes only so many requests."""
LOADING_S = 10.0
"""How long new settings may take [s]: a law that is used for the first time has its libraries loaded first."""
AGAIN_S = 0.02
URGENT = (StopRequest, DisarmRequest)
"""Requests that go ahead of everything else."""

Replies: TypeAlias = "queue.SimpleQueue[zenoh.Reply | None]"


@final
class OperatorEnd:
    """A session to one robot side. Callbacks come on zenoh's thread.

    robot: its name in the network; "" if there is only one, which `welcome` finds.
    """

    def __init__(self, connect: str, robot: str = "") -> None:
        self.endpoint = connect
        self.robot = robot
        self._given = robot
        self.t: float | None = None
        """The time of the newest state that has come [s]: what a command echoes as `seen`."""
        self._on_state: Callable[[State], None] | None = None
        self._session = open_session(connect=connect)
        self._urgent = open_session(connect=connect)
        """A connection of its own: what goes there waits for nothing that is on its way on the other."""
        self._pace = Pace()
        self._clock = MonotonicClock()
        self._turn = threading.Lock()
        self._commands: zenoh.Publisher | None = None
        self._states: zenoh.Subscriber[None] | None = None

    def subscribe(self, on_state: Callable[[State], None]) -> None:
        """Call `on_state` with every state that comes."""
        self._on_state = on_state

        def receive(sample: zenoh.Sample) -> None:
            with contextlib.suppress(msgspec.DecodeError):  # of another protocol: `seek` says so
                state = decode_state(sample.payload.to_bytes())
                self.t = state.t
                with self._turn:
                    next_ = self._pace.heard(state.operator, state.heard, self._clock.now())
                    if next_ is not None:
                        self._put(next_)
                on_state(state)

        self._states = self._session.declare_subscriber(key(self.robot, "state"), receive)

    def send(self, command: Command) -> None:
        """Send a command, or keep the newest until those on their way were heard. Dropped in a congested network."""
        with self._turn:
            now = self._pace.send(command, self._clock.now())
            if now is not None:
                self._put(now)

    def _put(self, command: Command) -> None:
        commands = self._commands
        if commands is None:
            commands = self._commands = self._session.declare_publisher(
                key(self.robot, "command"),
                congestion_control=zenoh.CongestionControl.DROP,
                priority=zenoh.Priority.INTERACTIVE_HIGH,
                express=True,
            )
        with contextlib.suppress(zenoh.ZError):  # another robot's by now: the next one is sent to the right one
            commands.put(encode(command))

    def _get(self, what: str, message: object, timeout_s: float, robot: str, replies: Replies) -> None:
        """Ask `robot`, or all if that is "": each reply is put into `replies` as it comes, after the last a None."""
        session = self._urgent if isinstance(message, URGENT) else self._session
        session.get(
            key(robot or ANY, what),
            zenoh.handlers.Callback(replies.put, lambda: replies.put(None)),
            payload=encode(message),
            timeout=timeout_s,
            target=zenoh.QueryTarget.ALL,
            congestion_control=zenoh.CongestionControl.BLOCK,
            priority=zenoh.Priority.REAL_TIME if isinstance(message, URGENT) else zenoh.Priority.DATA,
            express=True,
        )

    def _ask(self, what: str, message: object, timeout_s: float, robot: str = "") -> dict[str, Answer]:
        """Return the answers by the names of the robots that gave them; `robot` "" asks all."""
        replies: Replies = queue.SimpleQueue()
        self._get(what, message, timeout_s, robot, replies)
        return {
            str(reply.ok.key_expr).split("/")[1]: decode_answer(reply.ok.payload.to_bytes())
            for reply in iter(replies.get, None)
            if reply.ok is not None
        }

    def request(self, request: AnyRequest) -> Accepted | Refused:
        """Ask the robot side for something; return its answer. Blocks for at most ANSWER_S, settings for LOADING_S.

        It is asked again where no answer comes in time, and the first one counts, to whichever asking it is.
        """
        what = "stop" if isinstance(request, StopRequest) else "request"
        slow = isinstance(request, ConfigureRequest)
        until = self._clock.now() + (LOADING_S if slow else ANSWER_S)
        replies: Replies = queue.SimpleQueue()
        while (left := until - self._clock.now()) > 0.0:
            self._get(what, request, left, self.robot, replies)
            with contextlib.suppress(queue.Empty):
                reply = replies.get(timeout=min(PATIENCE_S, left))
                if reply is None or reply.ok is None:  # nobody is there to answer yet
                    self._clock.sleep_until(self._clock.now() + AGAIN_S)
                    continue
                answer = decode_answer(reply.ok.payload.to_bytes())
                if isinstance(answer, Accepted | Refused):
                    return answer
        return Refused("No answer from the robot side.")

    def welcome(self, wait_s: float, ended: Callable[[], bool] = lambda: False) -> Welcome:
        """Say hello until the robot side answers.

        Raises LinkError after `wait_s` [s], if `ended()` says that it never will, or if the two sides do not fit.
        """
        clock = MonotonicClock()
        until = clock.now() + wait_s
        while True:
            found = self._hello(self.robot)
            if found is not None:
                return found
            if ended():
                raise LinkError("the robot side has ended before it was ready (see above)")
            if clock.now() > until:
                called = f" called {self.robot!r}" if self.robot else ""
                raise LinkError(
                    f"no robot side{called} answers at {self.endpoint}: "
                    f"start it with `overreach robot --listen {self.endpoint}`"
                )
            clock.sleep_until(clock.now() + AGAIN_S)

    def seek(self) -> Welcome | None:
        """Return the welcome of the robot side that is there now, by whatever name unless one was given; else None.

        From then on it is the one that is spoken to. Raises LinkError if the two sides do not fit.
        """
        before = self.robot
        found = self._hello(self._given)
        if self.robot != before:
            commands, states, self._commands = self._commands, self._states, None
            for old in (commands, states):
                if old is not None:
                    old.undeclare()  # type: ignore[no-untyped-call]  # zenoh's stub lacks the return type
            if self._on_state is not None:
                self.subscribe(self._on_state)
        return found

    def _hello(self, robot: str) -> Welcome | None:
        """Say hello once, to any robot if `robot` is ""; take the name of the one that answers."""
        answers = self._ask("hello", Hello(PROTOCOL, __version__), 0.5, robot)
        if len(answers) > 1:
            raise LinkError(f"there are several robots: choose one with --robot: {', '.join(sorted(answers))}")
        for name, answer in answers.items():
            if isinstance(answer, Welcome):
                self.robot = name
                return answer
            if isinstance(answer, Refused):
                raise LinkError(answer.reason)
        return None

    def close(self) -> None:
        """Close the session; without this the process could hang at its end."""
        for session in (self._urgent, self._session):
            session.close()  # type: ignore[no-untyped-call]  # zenoh's stub lacks the return type
