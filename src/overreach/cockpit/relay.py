"""Between the pages and the robot side: commands and questions up, the newest state down."""

from __future__ import annotations

import asyncio
import contextlib
import sys
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any, final

import msgspec
from fastapi import WebSocket, WebSocketDisconnect

from overreach.clock import MonotonicClock
from overreach.cockpit import wire
from overreach.cockpit.visitor import Visitor
from overreach.errors import LinkError, told
from overreach.link.messages import Accepted, AnyRequest, ConfigureRequest, Refused, Scene, Settings, State, Welcome
from overreach.link.operator_end import OperatorEnd
from overreach.requests import ArmRequest, DisarmRequest, ResetRequest, RestartRequest, StopRequest
from overreach.types import Command, Frame

ASKED_MOST = 8
"""How many questions of one page may wait for their answers."""
NO_SCENE = Scene((0.0, 0.0), (), (), ())
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
        self._newest = 0.0, self._clock.now()
        """The time of the newest state, 0 before the first, and when it came [s]."""
        self._operator = 0
        """Who has armed."""
        self._trouble = ""
        """Why there is no robot side to speak to, if it is known."""
        self._changing = asyncio.Lock()
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
        self._newest = state.t, self._clock.now()
        self._operator = state.operator
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
            async with self._changing:
                self._take_over(await asyncio.to_thread(self._link.welcome, 1.0))
        except LinkError:
            self._revision = -1  # not known: the next state asks again

    async def _watch(self) -> None:
        """Where nothing comes any more, look for a robot side under another name or of another version."""
        while True:
            await asyncio.sleep(SILENT_S)
            if self._clock.now() - self._newest[1] < SILENT_S:
                self._trouble = ""
                continue
            try:
                found = await asyncio.to_thread(self._link.seek)
                if found is not None:
                    self._take_over(found)
            except LinkError as error:
                if str(error) != self._trouble:
                    self._trouble = str(error)
                    for page in self._pages:
                        page.say(_unasked(self._trouble))
            except Exception as error:  # of the network's library, which has more than it names: there is a next time
                print(f"overreach: the robot side could not be looked for ({told(error)})", file=sys.stderr)

    def _take_over(self, welcome: Welcome) -> None:
        """Make `welcome` what is known of the robot side."""
        same = _robot(welcome) == _robot(self.welcome)
        self.welcome, self.settings, self.scene = welcome, welcome.settings, welcome.scene
        self._revision = welcome.revision
        for page in self._pages:
            page.say(wire.encode(wire.SettingsToPage(self.settings, self.scene) if same else self._greeting(page)))
        for show in list(self.on_settings):
            show(self.settings)

    def _greeting(self, page: Visitor) -> wire.Greeting:
        return wire.Greeting(page.operator, self.welcome, self.settings, self.scene)

    async def ask(self, request: AnyRequest) -> Accepted | Refused:
        """Ask the robot side, without holding up the pages. Stop has its own thread and waits for nothing else."""
        if isinstance(request, StopRequest):
            return await asyncio.get_running_loop().run_in_executor(self._stopper, self._link.request, request)
        return await asyncio.to_thread(self._link.request, request)

    async def configure(self, change: Callable[[Settings], Settings]) -> Accepted | Refused:
        """Ask for the settings in force with a `change`; every page is told when they are in force.

        One change after the other, so that none undoes another. Raises what `change` raises.
        """
        async with self._changing:
            wanted = change(self.settings)
            if wanted == self.settings:
                return Accepted()
            answer = await self.ask(ConfigureRequest(wanted))
            if isinstance(answer, Accepted):
                self.settings = wanted
            return answer

    async def serve(self, socket: WebSocket) -> None:
        """Serve one page until it is gone; then let go of the robot and disarm for it."""
        page = Visitor(socket, self._clock)
        page.say(wire.encode(self._greeting(page)))
        if self._trouble:
            page.say(_unasked(self._trouble))
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
            self._spawn(self.ask(DisarmRequest(page.operator)))
            self._link.send(Command(page.operator, page.seq + 1, page.grip, False))
            with contextlib.suppress(Exception, asyncio.CancelledError):
                await sender

    async def _take(self, page: Visitor, text: str) -> None:
        """Pass on one message of a page; what is not understood is dropped, and the page told."""
        try:
            if len(text) > wire.LONGEST:
                raise msgspec.DecodeError("message is too long")
            message = wire.decode_from_page(text)
        except msgspec.DecodeError as error:
            page.say(_unasked(f"Not understood: {error}"))
            return
        if isinstance(message, wire.CommandFromPage):
            self._command(page, message)
        elif isinstance(message, wire.BeatFromPage):
            page.seq = message.seq
            if page.operator == self._operator:
                # So that a release that was lost is told after all, and that its delay is known before it drives.
                self._link.send(Command(page.operator, page.seq, page.grip, False, seen=message.seen))
        elif isinstance(message, wire.AskFromPage):
            self._spawn(self._answer(page, message))
        if isinstance(message, wire.CommandFromPage | wire.BeatFromPage):
            t, came = self._newest
            page.heard(message.seq, t, self._clock.now() - came)
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
        turning = what == "frame" and frame in tuple(Frame)
        request = requests.get(question.what)
        answer: Accepted | Refused
        if request is None and not turning:
            answer = Refused(f"Unknown button {question.what!r}.")
        elif isinstance(request, StopRequest):
            answer = await self.ask(request)
        elif page.asked >= ASKED_MOST:
            answer = Refused("Too many questions at once.")
        else:
            page.asked += 1
            try:
                async with page.turn:  # in the order in which they were asked
                    if request is None:
                        answer = await self.configure(lambda now: msgspec.structs.replace(now, frame=Frame(frame)))
                    else:
                        answer = await self.ask(request)
            finally:
                page.asked -= 1
        reason = answer.reason if isinstance(answer, Refused) else ""
        page.say(wire.encode(wire.AnswerToPage(question.id, not reason, reason)))


def _unasked(reason: str) -> bytes:
    """Return something to tell that answers no question."""
    return wire.encode(wire.AnswerToPage(-1, False, reason))


def _robot(welcome: Welcome) -> Welcome:
    """Return what stays the same when settings change."""
    return msgspec.structs.replace(welcome, settings=welcome.defaults, scene=NO_SCENE, revision=0)
