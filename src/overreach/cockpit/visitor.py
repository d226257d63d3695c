"""One connected page: what waits for it, in which order it goes out, and how many pictures may be on their way."""

from __future__ import annotations

import asyncio
import secrets
from collections import deque
from math import inf
from typing import final

from fastapi import WebSocket

from overreach.clock import Clock
from overreach.cockpit import wire

SAID_MOST = 32
"""How many answers wait for a page that does not read; older ones are dropped."""
PICTURES_MOST = 6
"""How many pictures may be on their way to a page that has not told that they came."""
LONGER_S = 0.1
LITTLE_LONGER_S = 0.05
"""A picture that took LONGER_S more than one alone does makes it one fewer; some that did not, one more [s]."""
CAREFUL_S = 3.0
"""After one fewer there is none more for this long [s]."""
ALONE_AGAIN_S = 10.0
"""Where there are fewer, how long one alone takes is measured anew this often [s]."""
OPERATOR_BITS = 52
"""Operator numbers are random and fit into a JavaScript number."""


@final
class Window:
    """The pictures that are on their way: a link in which they queue up gets fewer, however long it is."""

    def __init__(self) -> None:
        self.most = PICTURES_MOST
        self._away: deque[tuple[int, float]] = deque()
        self._least = inf
        self._alone_at = -inf
        self._alone = False
        self._quick = 0
        self._fewer_at = -inf

    @property
    def open(self) -> bool:
        """Whether another may be sent."""
        return len(self._away) < (1 if self._alone else self.most)

    def sent(self, n: int, now: float) -> None:
        """Picture n leaves."""
        self._away.append((n, now))

    def shown(self, n: int, now: float) -> None:
        """Everything up to picture n has come."""
        took = None
        while self._away and self._away[0][0] <= n:
            took = now - self._away.popleft()[1]
        if took is None:
            return
        if self._alone and now - took >= self._alone_at:  # this one had the link to itself
            self._alone, self._least = False, took
        self._least = min(self._least, took)
        if took > self._least + LONGER_S:
            self.most = max(1, self.most - 1)
            self._quick, self._fewer_at = 0, now
        elif took <= self._least + LITTLE_LONGER_S and now - self._fewer_at > CAREFUL_S:
            self._quick += 1
            if self._quick > self.most and self.most < PICTURES_MOST:
                self.most += 1
                self._quick = 0
        if self.most < PICTURES_MOST and now - self._alone_at > ALONE_AGAIN_S:
            self._alone, self._alone_at = True, now


@final
class Visitor:
    """Holds only the newest picture: a slow page misses pictures, and delays nobody."""

    def __init__(self, socket: WebSocket, clock: Clock) -> None:
        self.operator = secrets.randbits(OPERATOR_BITS) + 1
        self.seq = 0
        self.grip = 0
        self.turn = asyncio.Lock()
        self.asked = 0
        self._socket = socket
        self._clock = clock
        self._window = Window()
        self._newest: tuple[int, bytes] | None = None
        self._heard: wire.HeardToPage | None = None
        self._said: deque[bytes] = deque(maxlen=SAID_MOST)
        self._wake = asyncio.Event()

    def show(self, n: int, picture: bytes) -> None:
        """Send picture n unless a newer one comes first."""
        self._newest = n, picture
        if self._window.open:
            self._wake.set()

    def shown(self, n: int) -> None:
        """The page has picture n."""
        self._window.shown(n, self._clock.now())
        if self._newest is not None and self._window.open:
            self._wake.set()

    def say(self, message: bytes) -> None:
        """Send `message` in any case."""
        self._said.append(message)
        self._wake.set()

    def heard(self, seq: int, t: float, ago: float) -> None:
        """Tell that everything up to `seq` was heard, when the robot's state of `t` had come `ago` before [s]."""
        self._heard = wire.HeardToPage(seq, t, round(ago, 4))
        self._wake.set()

    async def send_forever(self) -> None:
        """Send whatever is waiting, the shortest first, until the page is gone."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            while (message := self._next()) is not None:
                await self._socket.send_text(message.decode())

    def _next(self) -> bytes | None:
        if self._heard is not None:
            heard, self._heard = self._heard, None
            return wire.encode(heard)
        if self._said:
            return self._said.popleft()
        if self._newest is not None and self._window.open:
            (n, picture), self._newest = self._newest, None
            self._window.sent(n, self._clock.now())
            return picture
        return None
