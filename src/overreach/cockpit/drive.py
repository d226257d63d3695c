"""`overreach drive` and `overreach cockpit`: processes, ports and an orderly end."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import socket
import subprocess
import sys
import webbrowser
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import FrameType

from overreach.errors import LinkError, SetupError
from overreach.gate.gate import MAX_DELAY_S, check_delay
from overreach.link.endpoint import check_endpoint, free_port

USUAL_PORT = 8420
ROBOT_WAIT_S = 10.0
END_WAIT_S = 2.0


def bind_page(host: str, port: int | None) -> socket.socket:
    """Return a listening socket for the page; without `port` at USUAL_PORT or, if that is taken, a free one.

    Raises SetupError if the given port is taken or not valid, or if the host is not this machine's.
    """
    if not host:
        raise SetupError("--host must be an address or a name, such as 127.0.0.1 or 0.0.0.0")
    if port is not None and not 0 < port < 65536:
        raise SetupError(f"--port must be 1 to 65535, got {port}")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    for choice in (USUAL_PORT, 0) if port is None else (port,):
        page = socket.socket(family, socket.SOCK_STREAM)
        page.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            page.bind((host, choice))
            page.listen()  # now, not when the server runs: a port that is only bound can be bound again
        except OSError as error:
            page.close()
            if choice != USUAL_PORT or port is not None or error.errno != errno.EADDRINUSE:
                raise SetupError(
                    f"the page cannot be served at {host}{f':{choice}' if choice else ''} ({error.strerror}): "
                    "choose another --port, or an address of this machine as --host"
                ) from None
        else:
            return page
    raise AssertionError("not reached: the last choice returns or raises")


def has_browser() -> bool:
    """Say whether there is a screen with a browser on it."""
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return False
    try:
        webbrowser.get()
    except webbrowser.Error:
        return False
    return True


def _exit_on_signals() -> None:
    """Make SIGTERM and SIGHUP unwind the stack, so that both halves are always closed."""

    def leave(number: int, _frame: FrameType | None) -> None:
        raise SystemExit(128 + number)

    signal.signal(signal.SIGTERM, leave)
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:  # as `nohup` leaves it
        signal.signal(signal.SIGHUP, leave)


@contextmanager
def robot_process(
    robot: str, rate: float, options: Sequence[str] = ()
) -> Iterator[tuple[str, subprocess.Popen[bytes]]]:
    """Run the robot side in a process of its own; yield its endpoint and the process, which ends with the block."""
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    command = [sys.executable, "-m", "overreach", "robot", robot, "--listen", endpoint]
    command += ["--rate", str(rate), "--parent", str(os.getpid()), *options]
    # A session of its own: Ctrl-C reaches the operator side alone, which then ends this one in order.
    process = subprocess.Popen(command, start_new_session=True)
    try:
        yield endpoint, process
    finally:
        process.terminate()
        try:
            process.wait(END_WAIT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def run_drive(
    robot: str,
    host: str,
    port: int | None,
    rate: float,
    browser: bool,
    law: str = "",
    changes: Sequence[str] = (),
    allowed: Sequence[str] = (),
    hosted: bool = True,
    max_delay: float = MAX_DELAY_S,
) -> None:
    """Run both halves until Ctrl-C or SIGTERM, or until one of them ends.

    changes: parameters of the law, NAME=VALUE; allowed: further names that the page is served under; hosted: whether
    the robot runs in a process of its own; max_delay [s]: how old a command may be.
    """
    from overreach.cockpit.origin import check_host_name
    from overreach.parameters import assignments
    from overreach.plugs import load_law
    from overreach.robot_side.process import check_rate
    from overreach.robots.load import check_robot_name

    check_robot_name(robot)
    check_rate(rate)
    check_delay(max_delay)
    if law or changes:
        load_law(law or "exact", assignments(changes))  # the usual ones have the same parameters
    hosts = [host, *map(check_host_name, allowed)]
    _exit_on_signals()
    given = [*(["--law", law] if law else []), *(["--set", *changes] if changes else [])]
    given += [*([] if hosted else ["--no-hosted"]), "--max-delay", str(max_delay)]
    with contextlib.closing(bind_page(host, port)) as page, robot_process(robot, rate, given) as (endpoint, process):
        _operate(endpoint, page, hosts, browser, lambda: process.poll() is not None)
        if process.poll() is not None:
            raise LinkError(f"the robot side has ended by itself (exit code {process.returncode}); so has the page")


def run_cockpit(
    connect: str, host: str, port: int | None, browser: bool, robot: str = "", allowed: Sequence[str] = ()
) -> None:
    """Run the operator side alone, for a robot side that is already running.

    robot: its name if there are several; allowed: further names that the page is served under.
    """
    from overreach.cockpit.origin import check_host_name
    from overreach.link.messages import check_name

    endpoint = check_endpoint(connect)
    if robot:
        check_name(robot)
    hosts = [host, *map(check_host_name, allowed)]
    _exit_on_signals()
    with contextlib.closing(bind_page(host, port)) as page:
        _operate(endpoint, page, hosts, browser, lambda: False, robot)


def _operate(
    endpoint: str, page: socket.socket, hosts: Sequence[str], browser: bool, lost: Callable[[], bool], robot: str = ""
) -> None:
    # Imported while the robot side starts: the page's library takes the longest.
    from overreach.cockpit.relay import Relay
    from overreach.cockpit.server import serve
    from overreach.link.operator_end import OperatorEnd

    link = OperatorEnd(endpoint, robot)
    try:
        relay = Relay(link, link.welcome(ROBOT_WAIT_S, lost))
        host = hosts[0]
        shown = "127.0.0.1" if host in ("0.0.0.0", "::") else host
        port = page.getsockname()[1]
        address = f"http://[{shown}]:{port}" if ":" in shown else f"http://{shown}:{port}"

        def ready() -> None:
            with contextlib.suppress(BrokenPipeError):  # whoever started it does not listen: it serves all the same
                print(f"overreach: drive at {address}   (Ctrl-C ends)", flush=True)
            if browser and has_browser():
                webbrowser.open(address)

        serve(relay, page, hosts, ready, lost)
    finally:
        link.close()
