"""Zenoh sessions with explicit endpoints: no multicast, no gossip, no router."""

from __future__ import annotations

import json
import re
import socket

import zenoh

from overreach.errors import LinkError, SetupError

_ENDPOINT = re.compile(r"^(tcp|udp)/(\[[0-9a-fA-F:]+\]|[^/:\s]+):(\d{1,5})$")


def check_endpoint(endpoint: str) -> str:
    """Return a zenoh endpoint; HOST:PORT is taken as tcp/HOST:PORT. Raises SetupError for anything else."""
    full = endpoint if "/" in endpoint else f"tcp/{endpoint}"
    match = _ENDPOINT.match(full)
    if not match or not 0 < int(match.group(3)) < 65536:
        raise SetupError(f"{endpoint!r} is no endpoint: use HOST:PORT or tcp/HOST:PORT, such as 127.0.0.1:7460")
    return full


def free_port(host: str = "127.0.0.1") -> int:
    """Return a TCP port on `host` that was free a moment ago."""
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        probe.bind((host, 0))
        port: int = probe.getsockname()[1]
        return port


def open_session(listen: str | None = None, connect: str | None = None) -> zenoh.Session:
    """Open a peer that listens at or connects to one endpoint and looks for no other.

    Raises LinkError if it cannot listen at the endpoint. A connection is retried forever.
    """
    config = zenoh.Config()
    settings: dict[str, object] = {
        "mode": "peer",
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "listen/endpoints": [listen] if listen else [],
        "connect/endpoints": [connect] if connect else [],
        "connect/timeout_ms": -1,
        "connect/exit_on_failure": False,
        "connect/retry": {"period_init_ms": 20, "period_max_ms": 500, "period_increase_factor": 1.5},
        "transport/link/tx/lease": 2000,
        "transport/link/tx/keep_alive": 4,
    }
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        where = f"listen at {listen}" if listen else f"connect to {connect}"
        reason = str(error).splitlines()[0].partition(" at /")[0]
        hint = "is the port taken, or the address not this machine's?" if listen else "is the address right?"
        raise LinkError(f"cannot {where}: {hint} ({reason})") from None
