"""Between the pages and the robot side: commands and questions up, the newest state down."""

from __future__ import annotations

import asyncio
import contextlib
import secrets
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any, final

import msgspec
from fastapi import WebSocket, WebSocketDisconnect

from overreach.cockpit import wire
from overreach.errors import LinkError
from overreach.link.messages import Accepted, AnyRequest, ConfigureRequest, Refused, Settings, State, Welcome
from overreach.link.operator_end import OperatorEnd
from overreach.requests import ArmRequest, DisarmRequest, ResetRequest, RestartRequest, StopRequest
from overreach.types import Command

SAID_MOST = 32
"""How many answers wait for a page that does not read; older ones are dropped."""
ASKED_MOST = 8
"""How many questions of one page may wait for their answers."""
OPERATOR_BITS = 52
"""Operator numbers are random and fit into a JavaScript number."""


@final
class Page:
    """One connected page. Holds only the newest state: a slow page misses states, and delays nobody."""

    def __init__(self, socket: WebSocket) -> None:
        self.operator = secrets.randbits(OPERATOR_BITS) + 1
        self.seq = 0
        self.grip = 0
        self._socket = socket
        self._newest: bytes | None = None
        self._said: list[bytes] = []
        self._wake = asyncio.Event()
        self.turn = asyncio.Lock()
        self.asked = 0

    def show(self, state: bytes) -> None:
        """Send `state` unless a newer one comes first."""
        self._newest = state
        self._wake.set()

    def say(self, message: bytes) -> None:
        """Send `message` in any case."""
        self._said.append(message)
        del self._said[:-SAID_MOST]
        self._wake.set()

    async def send_forever(self) -> None:
        """Send whatever is waiting, until the page is gone."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            said, self._said = self._said, []
            newest, self._newest = self._newest, None
            for message in said:
                await self._socket.send_text(message.decode())
            if newest is not None:
                await self._socket.send_text(newest.decode())


@final
class Relay:
    """The pages of this cockpit and its one robot side."""

    def __init__(self, link: OperatorEnd, welcome: Welcome) -> None:
        self.welcome = welcome
        self.settings = welcome.settings
        self.scene = welcome.scene
        self.on_settings: set[Callable[[Settings], None]] = set()
        """Called, on the event loop, with settings that have come into force."""
        self._link = link
        self._pages: set[Page] = set()
        self._revision = welcome.revision
        self._stopper = ThreadPoolExecutor(1, "stop")
        self._loop: asyncio.AbstractEventLoop | None = None
        self._tasks: set[asyncio.Task[object]] = set()

    def start(self) -> None:
        """Begin to receive states. Call on the event loop."""
        self._loop = asyncio.get_running_loop()
        self._link.subscribe(self._from_robot)

    def _from_robot(self, state: State) -> None:
        """Take a state, on zenoh's thread."""
        if (self._pages or state.revision != self._revision) and self._loop is not None:
            message = wire.encode(wire.StateToPage(state))
            with contextlib.suppress(RuntimeError):  # The event loop has closed: the cockpit is ending.
                self._loop.call_soon_threadsafe(self._show, message, state.revision)

    def _show(self, message: bytes, revision: int) -> None:
        for page in self._pages:
            page.show(message)
        if revision != self._revision:
            self._revision = revision
            self._spawn(self._refresh())

    def _spawn(self, work: Coroutine[Any, Any, object]) -> None:
        task: asyncio.Task[object] = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _refresh(self) -> None:
        """Fetch settings that somebody has changed, and tell every page."""
        try:
            welcome = await asyncio.to_thread(self._link.welcome, 1.0)
        except LinkError:
            self._revision = -1  # not known: the next state asks again
            return
        self.settings, self.scene = welcome.settings, welcome.scene
        for page in self._pages:
            page.say(wire.encode(wire.SettingsToPage(self.settings, self.scene)))
        for told in list(self.on_settings):
            told(self.settings)

    async def ask(self, request: AnyRequest) -> Accepted | Refused:
        """Ask the robot side, without holding up the pages. Stop has its own thread and waits for nothing else."""
        if isinstance(request, StopRequest):
            return await asyncio.get_running_loop().run_in_executor(self._stopper, self._link.request, request)
        return await asyncio.to_thread(self._link.request, request)

    async def configure(self, settings: Settings) -> Accepted | Refused:
        """Ask for new settings; every page is told when they are in force."""
        answer = await self.ask(ConfigureRequest(settings))
        if isinstance(answer, Accepted):
            self.settings = settings
        return answer

    async def serve(self, socket: WebSocket) -> None:
        """Serve one page until it is gone; then let go of the robot and disarm for it."""
        page = Page(socket)
        page.say(wire.encode(wire.Greeting(page.operator, self.welcome, self.settings, self.scene)))
        self._pages.add(page)
        sender = asyncio.create_task(page.send_forever())
        try:
            while True:
                await self._take(page, await socket.receive_text())
        except (WebSocketDisconnect, RuntimeError, KeyError):
            pass  # gone, or it sent something other than text
        finally:
            self._pages.discard(page)
            sender.cancel()
            self._link.send(Command(page.operator, page.seq + 1, page.grip, False))
            self._spawn(self.ask(DisarmRequest(page.operator)))
            with contextlib.suppress(Exception, asyncio.CancelledError):
                await sender

    async def _take(self, page: Page, text: str) -> None:
        """Pass on one message of a page; what is not understood is dropped, and the page told."""
        try:
            if len(text) > wire.LONGEST:
                raise msgspec.DecodeError("message is too long")
            message = wire.decode_from_page(text)
        except msgspec.DecodeError as error:
            page.say(wire.encode(wire.AnswerToPage(-1, False, f"Not understood: {error}")))
            return
        if isinstance(message, wire.CommandFromPage):
            page.seq, page.grip = message.seq, message.grip
            self._link.send(Command(page.operator, *msgspec.structs.astuple(message)))  # untouched
        else:
            self._spawn(self._answer(page, message))

    async def _answer(self, page: Page, question: wire.AskFromPage) -> None:
        requests: dict[str, AnyRequest] = {
            "stop": StopRequest(),
            "reset": ResetRequest(),
            "arm": ArmRequest(page.operator, page.grip),
            "disarm": DisarmRequest(page.operator),
            "restart": RestartRequest(),
        }
        request = requests.get(question.what)
        answer: Accepted | Refused
        if request is None:
            answer = Refused(f"Unknown button {question.what!r}.")
        elif isinstance(request, StopRequest):
            answer = await self.ask(request)
        elif page.asked >= ASKED_MOST:
            answer = Refused("Too many questions at once.")
        else:
            page.asked += 1
            try:
                async with page.turn:  # in the order in which they were asked
                    answer = await self.ask(request)
            finally:
                page.asked -= 1
        reason = answer.reason if isinstance(answer, Refused) else ""
        page.say(wire.encode(wire.AnswerToPage(question.id, not reason, reason)))
