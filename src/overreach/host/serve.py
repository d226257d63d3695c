"""The host's turn: take the loop's newest write, move the robot, and tell how it is."""

from __future__ import annotations

import contextlib
import os
import select
from collections.abc import Callable
from typing import cast, final

import msgspec

from overreach.clock import Clock
from overreach.gate.watchdog import Rates, Watchdog
from overreach.host.mailbox import Mailbox
from overreach.host.records import Ask, Report, decode_ask, encode
from overreach.model.model import channels
from overreach.robots.base import Handed, Robot, sentence
from overreach.types import RobotState

AHEAD_S = 0.0005
"""The robot is read this long [s] before the loop wants to know ..."""
AHEAD_PART = 0.25
"""... and never more than this part of a period."""


@final
class Host:
    """Serves one robot to one loop, by the mailboxes `asks` and `reports`. `door` wakes it, and ends with the loop."""

    def __init__(self, robot: Robot, period: float, clock: Clock, asks: Mailbox, reports: Mailbox, door: int) -> None:
        self._robot, self._period, self._clock = robot, period, clock
        self._asks, self._reports, self._door = asks, reports, door
        self._watchdog = Watchdog(channels(robot.model), period)
        self._ahead = min(AHEAD_S, AHEAD_PART * period)
        self._ask = Ask()
        self._gripper: float | None = None
        self._unwritable = self._unarmed = self._undone = ""
        self._look = clock.now()

    def run(self) -> None:
        """Serve until the loop has ended and the robot is at rest."""
        try:
            while self._wait():
                self.turn()
            self._watchdog.end(self._clock.now())
            while not self._watchdog.resting:
                self.turn()
                self._clock.sleep_until(self._clock.now() + self._period)
        finally:
            with contextlib.suppress(Exception):  # zero was written already, as far as it could be
                self._robot.stop(self._clock.now())

    def _wait(self) -> bool:
        """Wait until there is something to do; say whether there still is a loop."""
        wait = min(self._look, self._watchdog.wakes) - self._clock.now()
        ready, _, _ = select.select([self._door], [], [], max(0.0, wait))
        return not ready or bool(os.read(self._door, 4096))

    def turn(self) -> None:
        """Do all that is due now."""
        message = self._asks.get()
        now = self._clock.now()
        if message is not None:
            self._take(decode_ask(message), now)
        rates = self._watchdog.tick(now)
        if rates is not None:
            self._write(rates, now, now + self._period)
        if now >= self._look:
            self._tell(now)

    def _take(self, ask: Ask, now: float) -> None:
        before, self._ask = self._ask, ask
        if ask.rates:
            self._look = ask.now + self._period - self._ahead
        if ask.hand != before.hand:
            self._unarmed = _failure("given another hand", lambda _: cast(Handed, self._robot).choose(ask.hand), now)
        if ask.arms > before.arms:
            self._unarmed = _failure("armed", self._robot.arm, now)
        if ask.rates:
            rates = self._watchdog.take(ask.rates, now, ask.due, ask.arms)
            self._gripper = ask.gripper
            self._write(rates, now, ask.due)
        if ask.restarts > before.restarts:
            self._undone = _failure("put back", self._robot.restart, now)
        if ask.stops > before.stops:
            self._undone = _failure("stopped", self._robot.stop, now)
        if (ask.restarts, ask.stops) != (before.restarts, before.stops):
            self._watchdog.halt()
            self._look = now

    def _write(self, rates: Rates, now: float, due: float) -> None:
        base = self._robot.model.base
        try:
            self._robot.write(base.twist(rates), rates[base.axes :], self._gripper, now, due)
            self._unwritable = ""
        except Exception as error:
            self._unwritable = sentence("written to", error)

    def _tell(self, now: float) -> None:
        """Read the robot, and report."""
        while self._look <= now:
            self._look += self._period
        try:
            self._reports.put(encode(self._report(now, self._read(now), "")))
        except Exception as error:  # a driver may raise anything, and report what nobody can read
            self._reports.put(encode(self._report(now, None, sentence("read", error))))

    def _read(self, now: float) -> RobotState:
        state = self._robot.read(now).plain
        takeover = self._watchdog.takeover
        return state if takeover is None else msgspec.structs.replace(state, takeover=takeover)

    def _report(self, now: float, state: RobotState | None, unreadable: str) -> Report:
        ask = self._ask
        failed = self._unarmed or self._unwritable
        return Report(now, state, unreadable, failed, self._undone, ask.number, ask.arms, ask.restarts, ask.stops)


def _failure(did: str, call: Callable[[float], None], now: float) -> str:
    """Make a call of the robot; return what it raised, as a sentence, or ""."""
    try:
        call(now)
    except Exception as error:  # a driver may raise anything
        return sentence(did, error)
    return ""
