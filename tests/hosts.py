"""Two hosts and a wire between them: network namespaces and veth where the machine can make them, else a relay."""

from __future__ import annotations

import os
import secrets
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import final

from overreach.link.endpoint import free_port
from tests.narrow import Narrow, narrow
from tests.processes import Half, Observer, half

PORT = 7460
NAMESPACES = "two network namespaces joined by veth"
RELAY = "a relay on one host"


def run(*words: str) -> bool:
    """Run a command; say whether it succeeded."""
    return subprocess.run(words, capture_output=True, check=False).returncode == 0


@final
class Hosts:
    """The robot's host, an observer beside the robot, and an operator's host that `begin` begins a command on."""

    def __init__(self, kind: str, running: Half, observer: Observer, begin: list[str], endpoint: str) -> None:
        self.kind, self.running, self.observer = kind, running, observer
        self.begin, self.endpoint = begin, endpoint
        self.relay: Narrow | None = None
        self._wire: tuple[str, str] | None = None

    def cut(self, cut: bool = True) -> None:
        """Cut the wire, or join it again."""
        if self._wire is not None:
            space, device = self._wire
            assert run("ip", "-n", space, "link", "set", device, "down" if cut else "up")
        elif self.relay is not None:
            self.relay.up.cut = self.relay.down.cut = cut

    def narrow(self, rate: float) -> None:
        """Let only `rate` [bytes/s] through to the robot."""
        if self._wire is not None:
            space, device = self._wire
            limits = ["rate", f"{8.0 * rate:.0f}bit", "burst", "1600", "limit", "60000"]
            assert run("ip", "netns", "exec", space, "tc", "qdisc", "replace", "dev", device, "root", "tbf", *limits)
        elif self.relay is not None:
            self.relay.up.rate = rate

    def widen(self) -> None:
        """Let everything through again."""
        if self._wire is not None:
            space, device = self._wire
            run("ip", "netns", "exec", space, "tc", "qdisc", "del", "dev", device, "root")
        elif self.relay is not None:
            self.relay.up.rate = float("inf")

    def sent(self) -> int:
        """Return how many bytes have gone to the robot's host."""
        if self._wire is not None:
            space, device = self._wire
            path = f"/sys/class/net/{device}/statistics/tx_bytes"
            read = ["ip", "netns", "exec", space, "cat", path]
            return int(subprocess.run(read, capture_output=True, text=True, check=True).stdout)
        assert self.relay is not None
        return self.relay.up.passed

    def operator(self) -> subprocess.Popen[str]:
        """Start an operator who has armed and pushes; it does what it is told, line by line."""
        command = [*self.begin, sys.executable, "-m", "tests.faults.pusher", self.endpoint]
        return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)


@contextmanager
def two_hosts() -> Iterator[Hosts]:
    """Run a robot side on one host; yield both."""
    name = secrets.token_hex(2)
    a, b = f"operator-{name}", f"robot-{name}"
    wire, other, near, far = (f"ov{name}{k}" for k in range(4))
    with ExitStack() as left:
        left.callback(run, "ip", "netns", "del", a)
        left.callback(run, "ip", "netns", "del", b)
        left.callback(run, "ip", "link", "del", near)
        made = shutil.which("ip") and os.geteuid() == 0 and all(
            run("ip", *words.split()) for words in (
                f"netns add {a}", f"netns add {b}",
                f"link add {wire} netns {a} type veth peer name {other} netns {b}",
                f"link add {near} type veth peer name {far} netns {b}",
                f"-n {a} addr add 10.77.0.1/24 dev {wire}", f"-n {b} addr add 10.77.0.2/24 dev {other}",
                f"addr add 10.78.0.1/24 dev {near}", f"-n {b} addr add 10.78.0.2/24 dev {far}",
                f"-n {a} link set {wire} up", f"-n {b} link set {other} up", f"-n {a} link set lo up",
                f"-n {b} link set lo up", f"link set {near} up", f"-n {b} link set {far} up",
            )
        )  # fmt: skip
        if made:
            begin = ["ip", "netns", "exec"]
            running = left.enter_context(half("robot", "--listen", f"0.0.0.0:{PORT}", begin=[*begin, b]))
            observer = Observer(f"tcp/10.78.0.2:{PORT}")
            left.callback(observer.close)
            hosts = Hosts(NAMESPACES, running, observer, [*begin, a], f"tcp/10.77.0.2:{PORT}")
            hosts._wire = a, wire
        else:
            port = free_port()
            running = left.enter_context(half("robot", "--listen", f"127.0.0.1:{port}"))
            observer = Observer(f"tcp/127.0.0.1:{port}")
            left.callback(observer.close)
            relay = left.enter_context(narrow(port))
            hosts = Hosts(RELAY, running, observer, [], f"tcp/127.0.0.1:{relay.port}")
            hosts.relay = relay
        yield hosts
