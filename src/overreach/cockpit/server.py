"""The web server of the cockpit: NiceGUI's page, our static files and the WebSocket, on one port."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path

import uvicorn
from fastapi import FastAPI, WebSocket
from fastapi.staticfiles import StaticFiles
from nicegui import ui

from overreach.cockpit.origin import OwnPagesOnly
from overreach.cockpit.page import build_page
from overreach.cockpit.relay import Relay

STATIC = Path(__file__).parent / "static"
WATCH_S = 0.1


def serve(
    relay: Relay, bound: socket.socket, hosts: Sequence[str], on_ready: Callable[[], None], lost: Callable[[], bool]
) -> None:
    """Serve, under the names `hosts`, until a signal comes or `lost()` says that the robot side has ended."""

    @asynccontextmanager
    async def lifespan(_app: FastAPI) -> AsyncIterator[None]:
        relay.start()
        watcher = asyncio.create_task(watch())
        yield
        watcher.cancel()

    async def watch() -> None:
        while not server.started:
            await asyncio.sleep(0.01)
        on_ready()
        while not lost():
            await asyncio.sleep(WATCH_S)
        server.should_exit = True

    app = FastAPI(lifespan=lifespan, openapi_url=None)

    @app.websocket("/ws")
    async def talk(websocket: WebSocket) -> None:
        await websocket.accept()
        await relay.serve(websocket)

    app.add_middleware(OwnPagesOnly, hosts=hosts)
    app.mount("/static", StaticFiles(directory=STATIC))
    ui.run_with(
        app,
        root=lambda: build_page(relay),
        title="overreach",
        favicon=STATIC / "favicon.svg",
        dark=None,
        tailwind=False,
        show_welcome_message=False,
        binding_refresh_interval=None,
    )
    config = uvicorn.Config(
        app,
        log_level="warning",
        access_log=False,
        ws_per_message_deflate=False,
        ws_max_size=64 * 1024,
        timeout_graceful_shutdown=1,
    )
    server = uvicorn.Server(config)
    server.run(sockets=[bound])
