"""Robot side and operator on two hosts: the wire between them is cut, joined, and made too narrow."""

from __future__ import annotations

import random
import subprocess
import time

import pytest

from overreach.gate.gate import LOST_S, STALE_S
from tests.hosts import Hosts, two_hosts
from tests.processes import until
from tests.reached import Reached
from tests.side import STOP_S

pytestmark = pytest.mark.timed

NOISE_S = 0.1
ROW = "two hosts: cut, restore, delay, narrow"


def tell(operator: subprocess.Popen[str], word: str) -> str:
    """Tell an operator what to do; return what it says."""
    assert operator.stdin
    assert operator.stdout
    operator.stdin.write(f"{word}\n")
    return operator.stdout.readline().strip()


def test_a_wire_that_is_cut_and_joined(reached: Reached) -> None:
    """Cut while driven: a ramp and a lost link; joined: nothing moves until a press; then it drives as before."""
    rng, times, rests, backs = random.Random(reached.seed), reached.times(20), [], []
    with two_hosts() as hosts:
        operator, observer = hosts.operator(), hosts.observer
        try:
            assert operator.stdout
            assert operator.stdout.readline().strip() == "pushes"
            for k in range(times):
                until(lambda: observer.speed() > 0.3, what="motion")
                time.sleep(rng.uniform(0.0, 0.3))
                hosts.cut()
                since = time.monotonic()
                long = k % 2 == 0
                time.sleep(rng.uniform(1.3, 2.5) if long else rng.uniform(0.5, 0.9))
                assert observer.speed() == 0.0
                assert observer.now.verdict == ("lost" if time.monotonic() - since > LOST_S + NOISE_S else "stale")
                rests.append(max(s.t for s in list(observer.states) if observer.speed(s) > 0.0) - since)
                assert rests[-1] < STALE_S + STOP_S + NOISE_S
                hosts.cut(False)
                joined = time.monotonic()
                until(lambda: observer.now.verdict == "regrip", what="the operator's return")
                backs.append(time.monotonic() - joined)
                time.sleep(1.0)
                assert not any(observer.speed(s) for s in list(observer.states) if s.t > joined)
                assert observer.now.armed
                tell(operator, "release")
                time.sleep(0.2)
                tell(operator, "press")
            until(lambda: observer.speed() > 0.3, what="motion")
        finally:
            operator.kill()
            operator.wait()
    reached.say(
        ROW,
        f"{hosts.kind}: cut {times} times while driven: at rest after {max(rests):.2f} s at most, no motion on return "
        f"({max(backs):.1f} s at most) until a new press",
    )


def narrowed(hosts: Hosts) -> tuple[float, float]:
    """Make the wire too narrow while driven; return how long letting go, and then a Stop, takes [s]."""
    operator, observer = hosts.operator(), hosts.observer
    try:
        assert operator.stdout
        assert operator.stdout.readline().strip() == "pushes"
        until(lambda: observer.speed() > 0.3, what="motion")
        sent, begun = hosts.sent(), time.monotonic()
        time.sleep(2.0)
        hosts.narrow(0.8 * (hosts.sent() - sent) / (time.monotonic() - begun))
        time.sleep(4.0)
        since = time.monotonic()
        tell(operator, "release")
        time.sleep(1.0)
        until(lambda: observer.speed() == 0.0, what="rest")
        rest = max(s.t for s in list(observer.states) if observer.speed(s) > 0.0) - since
        tell(operator, "press")
        time.sleep(2.0)
        pressed = time.monotonic()
        assert tell(operator, "stop").startswith("Accepted")
        until(lambda: observer.now.stopped, what="the stop")
        stop = next(s.t for s in list(observer.states) if s.t > pressed and s.stopped) - pressed
        hosts.widen()
        for word in ("reset", "release", "arm", "press"):
            tell(operator, word)
        until(lambda: observer.speed() > 0.3, what="motion again")
    finally:
        operator.kill()
        operator.wait()
    return max(0.0, rest), stop


def test_a_wire_that_is_too_narrow(reached: Reached) -> None:
    """20 % too narrow for what is sent: let go of, at rest in time; Stop within 0.3 s; wide again, it drives."""
    times, found = reached.times(20), []
    for _ in range(times):
        with two_hosts() as hosts:
            found.append(narrowed(hosts))
    rest, stop = map(max, zip(*found, strict=True))
    assert rest < 0.45 + 0.4 + NOISE_S
    assert stop < 0.3 + NOISE_S
    reached.say(
        ROW,
        f"{hosts.kind}: 20 % too narrow, {times} times: at rest {rest:.2f} s after letting go at most, Stop in force "
        f"after {stop:.2f} s at most",
    )
