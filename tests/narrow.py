"""A thin or long link: a TCP relay that passes on so many bytes a second each way, so much later, and loses nothing."""

from __future__ import annotations

import contextlib
import math
import queue
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

CHUNK = 512
LOOK_S = 0.01
BUFFER = 65536
UNDER_WAY = 256
"""Chunks that a long link holds."""


class Way:
    """One direction of the link, shared by all connections."""

    def __init__(self) -> None:
        self.rate = math.inf
        self.delay = 0.0
        self.cut = False
        self.passed = 0
        self._lock = threading.Lock()

    def pass_on(self, size: int) -> None:
        """Take as long as `size` bytes take, after those that came before."""
        with self._lock:
            at, left = time.monotonic(), float(size)
            while left > 0.0 and self.rate < math.inf:
                time.sleep(min(LOOK_S, left / self.rate))
                now = time.monotonic()
                left -= (now - at) * self.rate
                at = now
            self.passed += size


class Narrow:
    """Listens at `port` and connects to `target`; `up` and `down` [bytes/s] may be changed at any time."""

    def __init__(self, target: int) -> None:
        self.up, self.down = Way(), Way()
        self._target = target
        self._open: list[socket.socket] = []
        self._listener = socket.socket()
        self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER)
        self._listener.bind(("127.0.0.1", 0))
        self._listener.listen()
        self.port = self._listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                near, _ = self._listener.accept()
                far = socket.socket()
                far.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER)
                far.connect(("127.0.0.1", self._target))
                for one in (near, far):
                    one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._open += [near, far]
                for source, sink, way in ((near, far, self.up), (far, near, self.down)):
                    threading.Thread(target=self._pump, args=(source, sink, way), daemon=True).start()

    @staticmethod
    def _pump(source: socket.socket, sink: socket.socket, way: Way) -> None:
        # What is under way on a long link does not hold back its sender; a thin one does.
        coming: queue.Queue[tuple[float, bytes]] = queue.Queue(UNDER_WAY)

        def deliver() -> None:
            with contextlib.suppress(OSError):
                while True:
                    due, data = coming.get()
                    while way.cut or time.monotonic() < due:
                        time.sleep(LOOK_S if way.cut else max(0.0, due - time.monotonic()))
                    if not data:
                        break
                    sink.sendall(data)
            for one in (source, sink):
                with contextlib.suppress(OSError):
                    one.shutdown(socket.SHUT_RDWR)

        threading.Thread(target=deliver, daemon=True).start()
        with contextlib.suppress(OSError):
            while data := source.recv(CHUNK):
                way.pass_on(len(data))
                coming.put((time.monotonic() + way.delay, data))
        coming.put((0.0, b""))

    def close(self) -> None:
        for one in [self._listener, *self._open]:
            one.close()


@contextmanager
def narrow(target: int) -> Iterator[Narrow]:
    """Run a thin link to a local port; as wide as can be until told otherwise."""
    link = Narrow(target)
    try:
        yield link
    finally:
        link.close()
