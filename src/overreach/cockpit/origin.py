"""Who is served: only this cockpit's own pages, under an address that names this server."""

from __future__ import annotations

import ipaddress
import re
from collections.abc import Sequence
from html import escape
from typing import final
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.responses import HTMLResponse
from starlette.types import ASGIApp, Receive, Scope, Send

from overreach.errors import SetupError

HOST_NAME = re.compile(r"(?!-)[a-z0-9_-]{1,63}(\.(?!-)[a-z0-9_-]{1,63})*", re.IGNORECASE)


def check_host_name(name: str) -> str:
    """Return a machine's name as it is compared; raises SetupError if it is not one."""
    plain = _plain(name)
    if len(plain) > 253 or not HOST_NAME.fullmatch(plain):
        raise SetupError(f"--allow-host must be a machine's name alone, such as robot.local, got {name!r}")
    return plain


def _plain(name: str) -> str:
    return name.lower().removesuffix(".")


def _name(host: str) -> str:
    """Return the name in a Host header, without its port."""
    try:
        return _plain(urlsplit(f"//{host}").hostname or "")
    except ValueError:
        return ""


def known_host(host: str, served: Sequence[str]) -> bool:
    """Say whether a Host header names this server: an IP address, `localhost` or one of the names `served`.

    Any other name may have been pointed here by a foreign page (DNS rebinding).
    """
    name = _name(host)
    if name == "localhost" or name in served:
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

    def __init__(self, app: ASGIApp, hosts: Sequence[str]) -> None:
        self.app = app
        self.hosts = [_plain(host) for host in hosts]

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, or refuse it."""
        if scope["type"] in ("http", "websocket"):
            headers = Headers(scope=scope)
            allowed = known_host(headers.get("host", ""), self.hosts)
            if scope["type"] == "websocket" and not (allowed and same_origin(headers)):
                await send({"type": "websocket.close", "code": 1008})
                return
            if not allowed:
                page = HTMLResponse(unknown_host(headers.get("host", "")), 403, {"Content-Security-Policy": POLICY})
                await page(scope, receive, send)
                return
        await self.app(scope, receive, send)


POLICY = "default-src 'none'; style-src 'unsafe-inline'"
STYLE = "font: 16px/1.5 system-ui, sans-serif; max-width: 36em; margin: 15vh auto; padding: 0 1em"


def unknown_host(host: str) -> str:
    """Return the page that says why nothing is served under a name, and which option to use."""
    name = _name(host)
    name = name if HOST_NAME.fullmatch(name) else "NAME"
    option = f"--allow-host {name}"
    return (
        '<!doctype html><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
        '<meta name="color-scheme" content="light dark"><title>overreach: unknown host</title>'
        f'<body style="{STYLE}"><h1>Not served under this name</h1>'
        f"<p>This page was asked for as <b>{escape(name)}</b>, a name that it has not been told is its own: "
        "pages of other sites could reach the robot that way.</p>"
        f"<p>If it is this machine's name, start it with <code>{escape(option)}</code>, as in<br>"
        f"<code>overreach drive {escape(option)}</code> or <code>overreach cockpit {escape(option)}</code>,<br>"
        "or open the page by the machine's address.</p>"
    )
