"""Between the pages and the robot side: commands and questions up, the newest state down."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any, final

import msgspec
from fastapi import WebSocket, WebSocketDisconnect

from overreach.clock import MonotonicClock
from overreach.cockpit import wire
from overreach.cockpit.visitor import Visitor
from overreach.errors import LinkError
from overreach.link.messages import Accepted, AnyRequest, ConfigureRequest, Refused, Scene, Settings, State, Welcome
from overreach.link.operator_end import OperatorEnd
from overreach.requests import ArmRequest, DisarmRequest, ResetRequest, RestartRequest, StopRequest
from overreach.types import Command, Frame

ASKED_MOST = 8
"""How many questions of one page may wait for their answers."""
NO_SCENE = Scene((0.0, 0.0), (), ())
SILENT_S = 1.0
"""After this long without a state [s] it is asked whether the robot side is another than before."""


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
        self._clock = MonotonicClock()
        self._pages: set[Visitor] = set()
        self._revision = welcome.revision
        self._pictures = 0
        self._t = 0.0
        self._heard_at = self._clock.now()
        self._stopper = ThreadPoolExecutor(1, "stop")
        self._loop: asyncio.AbstractEventLoop | None = None
        self._tasks: set[asyncio.Task[object]] = set()

    def start(self) -> None:
        """Begin to receive states. Call on the event loop."""
        self._loop = asyncio.get_running_loop()
        self._link.subscribe(self._from_robot)
        self._spawn(self._watch())

    def _from_robot(self, state: State) -> None:
        """Take a state, on zenoh's thread."""
        self._t, self._heard_at = state.t, self._clock.now()
        if (self._pages or state.revision != self._revision) and self._loop is not None:
            self._pictures += 1
            message = wire.encode(wire.StateToPage(self._pictures, state))
            with contextlib.suppress(RuntimeError):  # The event loop has closed: the cockpit is ending.
                self._loop.call_soon_threadsafe(self._show, self._pictures, message, state.revision)

    def _show(self, n: int, message: bytes, revision: int) -> None:
        for page in self._pages:
            page.show(n, message)
        if revision != self._revision:
            self._revision = revision
            self._spawn(self._refresh())

    def _spawn(self, work: Coroutine[Any, Any, object]) -> None:
        task: asyncio.Task[object] = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _refresh(self) -> None:
        """Fetch what somebody has changed, or what a robot side that was started anew is, and tell every page."""
        try:
            self._take_over(await asyncio.to_thread(self._link.welcome, 1.0))
        except LinkError:
            self._revision = -1  # not known: the next state asks again

    async def _watch(self) -> None:
        """Where nothing comes any more, look for a robot side under another name or of another version."""
        told = ""
        while True:
            await asyncio.sleep(SILENT_S)
            if self._clock.now() - self._heard_at < SILENT_S:
                told = ""
                continue
            try:
                found = await asyncio.to_thread(self._link.seek)
            except LinkError as error:
                if str(error) != told:
                    told = str(error)
                    self._say(wire.AnswerToPage(-1, False, told))
                continue
            if found is not None:
                self._take_over(found)

    def _take_over(self, welcome: Welcome) -> None:
        """Make `welcome` what is known of the robot side."""
        same = _robot(welcome) == _robot(self.welcome)
        self.welcome, self.settings, self.scene = welcome, welcome.settings, welcome.scene
        self._revision = welcome.revision
        for page in self._pages:
            page.say(wire.encode(wire.SettingsToPage(self.settings, self.scene) if same else self._greeting(page)))
        for told in list(self.on_settings):
            told(self.settings)

    def _greeting(self, page: Visitor) -> wire.Greeting:
        return wire.Greeting(page.operator, self.welcome, self.settings, self.scene)

    def _say(self, message: object) -> None:
        for page in self._pages:
            page.say(wire.encode(message))

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
        page = Visitor(socket, self._clock)
        page.say(wire.encode(self._greeting(page)))
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

    async def _take(self, page: Visitor, text: str) -> None:
        """Pass on one message of a page; what is not understood is dropped, and the page told."""
        try:
            if len(text) > wire.LONGEST:
                raise msgspec.DecodeError("message is too long")
            message = wire.decode_from_page(text)
        except msgspec.DecodeError as error:
            page.say(wire.encode(wire.AnswerToPage(-1, False, f"Not understood: {error}")))
            return
        if isinstance(message, wire.CommandFromPage):
            self._command(page, message)
        elif isinstance(message, wire.BeatFromPage):
            page.seq = message.seq
        elif isinstance(message, wire.AskFromPage):
            self._spawn(self._answer(page, message))
        if isinstance(message, wire.CommandFromPage | wire.BeatFromPage):
            page.heard(message.seq, self._t)
        if not isinstance(message, wire.AskFromPage):
            page.shown(message.n if isinstance(message, wire.ShownFromPage) else message.shown)

    def _command(self, page: Visitor, said: wire.CommandFromPage) -> None:
        """Pass on a command, untouched."""
        page.seq, page.grip = said.seq, said.grip
        self._link.send(
            Command(page.operator, said.seq, said.grip, said.held, said.twist, said.frame, said.gripper, said.seen)
        )

    async def _answer(self, page: Visitor, question: wire.AskFromPage) -> None:
        requests: dict[str, AnyRequest] = {
            "stop": StopRequest(),
            "reset": ResetRequest(),
            "arm": ArmRequest(page.operator, page.grip),
            "disarm": DisarmRequest(page.operator),
            "restart": RestartRequest(),
        }
        what, _, frame = question.what.partition(" ")
        if what == "frame" and frame in tuple(Frame):
            requests[question.what] = ConfigureRequest(msgspec.structs.replace(self.settings, frame=Frame(frame)))
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


def _robot(welcome: Welcome) -> Welcome:
    """Return what stays the same when settings change."""
    return msgspec.structs.replace(welcome, settings=welcome.defaults, scene=NO_SCENE, revision=0)
