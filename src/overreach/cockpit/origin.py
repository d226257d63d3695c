"""Who is served: only this cockpit's own pages, under an address that names this server."""

from __future__ import annotations

import ipaddress
from typing import final
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Receive, Scope, Send


def known_host(host: str, served: str) -> bool:
    """Say whether a Host header names this server: an IP address, `localhost` or the name given with --host.

    Any other name may have been pointed here by a foreign page (DNS rebinding).
    """
    name = (urlsplit(f"//{host}").hostname or "").lower()
    if name in ("localhost", served.lower()):
        return True
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def same_origin(headers: Headers) -> bool:
    """Say whether the Origin header has the name and port of the Host header."""
    origin = urlsplit(headers.get("origin", ""))
    return origin.scheme in ("http", "https") and origin.netloc == headers.get("host", "")


@final
class OwnPagesOnly:
    """ASGI middleware: 403 to requests for a foreign Host, and to WebSockets of a foreign Origin."""

    def __init__(self, app: ASGIApp, host: str) -> None:
        self.app = app
        self.host = host

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or refuse it."""
        if scope["type"] in ("http", "websocket"):
            headers = Headers(scope=scope)
            allowed = known_host(headers.get("host", ""), self.host)
            if scope["type"] == "websocket" and not (allowed and same_origin(headers)):
                await send({"type": "websocket.close", "code": 1008})
                return
            if not allowed:
                await PlainTextResponse("Unknown host.", 403)(scope, receive, send)
                return
        await self.app(scope, receive, send)
