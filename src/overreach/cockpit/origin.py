"""Who may open the WebSocket: only pages that this cockpit served, under an address it is known by."""

from __future__ import annotations

import ipaddress
from collections.abc import Mapping
from urllib.parse import urlsplit


def same_origin(headers: Mapping[str, str], served_host: str) -> bool:
    """Say whether Origin and Host name this server.

    The Origin must have the Host's name and port. The Host must be an IP address, `localhost` or the
    name given with --host: any other name may have been pointed here by a foreign page (DNS rebinding).
    """
    host = headers.get("host", "")
    origin = urlsplit(headers.get("origin", ""))
    if not host or origin.scheme not in ("http", "https") or origin.netloc != host:
        return False
    name = urlsplit(f"//{host}").hostname or ""
    if name in ("localhost", served_host):
        return True
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
