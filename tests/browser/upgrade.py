"""A request for a WebSocket with any headers."""

from __future__ import annotations

import http.client


def upgrade(url: str, headers: dict[str, str], path: str = "/ws") -> int:
    """Ask for a WebSocket and return the status of the answer."""
    connection = http.client.HTTPConnection(url.removeprefix("http://"), timeout=10)
    try:
        handshake = {
            "Connection": "Upgrade",
            "Upgrade": "websocket",
            "Sec-WebSocket-Version": "13",
            "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
        }
        connection.request("GET", path, headers={**handshake, **headers})
        return connection.getresponse().status
    finally:
        connection.close()
