"""Zenoh sessions with explicit endpoints: no multicast, no gossip, no router."""

from __future__ import annotations

import json
import re
import socket
from collections.abc import Sequence

import zenoh

from overreach.errors import LinkError, SetupError

SEND_BUFFER = 32768
"""What may wait in a connection [bytes]: more of it would only be older."""
LONGEST_WHOLE = 1 << 20
"""Longest message [bytes] that is put together from its parts."""
CONNECTIONS = 1000
"""At most so many at a time, and so many that have said nothing yet ..."""
ACCEPT_MS = 3000
"""... for at most this long [ms]."""
WAIT_US = 1000
"""A peer that takes no answers holds up who gives them by at most this long [us]: then it is cut off."""
ANSWERS_WAIT = 8
"""So many answers of a kind may wait for a peer: of fewer, a moment in which none is sent would cut it off."""
REQUESTS_HZ = 200.0
"""Requests of one peer that come sooner after each other than this often are not looked at."""

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


def open_session(listen: str | None = None, connect: str | None = None, seldom: Sequence[str] = ()) -> zenoh.Session:
    """Open a peer that listens at or connects to one endpoint and looks for no other.

    seldom: keys at which each peer may ask for something at most REQUESTS_HZ times a second.

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
        "transport/link/tcp/so_sndbuf": SEND_BUFFER,
        "transport/link/rx/max_message_size": LONGEST_WHOLE,
        "transport/shared_memory/enabled": False,
        "transport/unicast/accept_timeout": ACCEPT_MS,
        "transport/unicast/accept_pending": CONNECTIONS,
        "transport/unicast/max_sessions": CONNECTIONS,
        "transport/link/tx/queue/congestion_control/drop/wait_before_drop": 0,
        "transport/link/tx/queue/congestion_control/drop/max_wait_before_drop_fragments": 0,
    }
    if listen:
        settings["transport/link/tx/queue/congestion_control/block/wait_before_close"] = WAIT_US
        settings["transport/link/tx/queue/size/real_time"] = ANSWERS_WAIT
        settings["transport/link/tx/queue/size/data"] = ANSWERS_WAIT
    if seldom:
        rules = [{"key_expr": key, "freq": REQUESTS_HZ} for key in seldom]
        settings["downsampling"] = [{"id": "seldom", "flows": ["ingress"], "messages": ["query"], "rules": rules}]
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        where = f"listen at {listen}" if listen else f"connect to {connect}"
        reason = str(error).splitlines()[0].partition(" at /")[0]
        hint = "is the port taken, or the address not this machine's?" if listen else "is the address right?"
        raise LinkError(f"cannot {where}: {hint} ({reason})") from None
