"""The loop's end of a robot in a process of its own: read what is reported, write what is to be done. Never waits."""

from __future__ import annotations

import contextlib
import os
import pickle
import select
import subprocess
import sys
from collections.abc import Callable
from typing import final

import msgspec

from overreach.clock import Clock
from overreach.errors import SetupError
from overreach.host.mailbox import Mailbox, shared_memory
from overreach.host.records import Ask, Made, Report, decode_report, encode
from overreach.robots.base import RobotFault
from overreach.types import BaseTwist, RobotState, Takeover

HUNG_S = 0.08
"""After this long [s] without a report, in which the loop itself kept going, the host is taken for dead."""
DONE_S = 1.0
"""How long to wait [s] until the robot was put back, or stopped."""
END_S = 2.0
"""A host without a loop has ended after this long [s]."""
LOOK_S = 0.001
MADE_S = 0.05

_with = msgspec.structs.replace


@final
class Hosted:
    """The robot called `robot`, hosted: see `overreach.robots.base.Robot`. End it by `close`.

    period: of the loop [s]; given_up: says whether nobody waits for it any more. Raises SetupError where the robot
    cannot be made.
    """

    def __init__(self, robot: str, period: float, clock: Clock, given_up: Callable[[], bool] = lambda: False) -> None:
        self._clock, self._period = clock, period
        asks, reports = shared_memory(), shared_memory()
        door, self._door = os.pipe()
        answer, ready = os.pipe()
        os.set_blocking(self._door, False)
        theirs = (asks, reports, door, ready)
        command = [sys.executable, "-m", "overreach.host", robot, repr(period), *map(str, theirs)]
        try:
            # A session of its own: what the terminal tells the loop, the host learns from the loop.
            self._process = subprocess.Popen(command, pass_fds=theirs, stdin=subprocess.DEVNULL, start_new_session=True)
            self._asks, self._reports = Mailbox(asks), Mailbox(reports)
        finally:
            for each in theirs:
                os.close(each)
        self._ask = Ask()
        self._report = Report(0.0, None, "The robot has reported nothing yet.")
        self._silent_s = 0.0
        self._read_at = clock.now()
        try:
            made = self._made(answer, given_up)
            if made.model is None:
                raise SetupError(made.wrong)
            self.model, self.simulated = made.model, made.simulated
            if not self._wait(lambda _: True):
                raise SetupError("the robot's host does not say how the robot is")
        except BaseException:
            self.close()
            raise
        finally:
            os.close(answer)

    def _made(self, answer: int, given_up: Callable[[], bool]) -> Made:
        """Wait for the host's first word."""
        told = b""
        while not given_up():
            if select.select([answer], [], [], MADE_S)[0]:
                part = os.read(answer, 65536)
                if not part:
                    break
                told += part
        else:
            raise SetupError("the robot was not waited for")
        if not told:
            raise SetupError("the robot could not be made (see above)")
        made: Made = pickle.loads(told)  # of our own child process
        return made

    @property
    def pid(self) -> int:
        """The host's process."""
        return self._process.pid

    def read(self, now: float) -> RobotState:
        """Return the newest state that was reported. Raises RobotFault where there is none, or no host any more."""
        before, self._read_at = self._read_at, now
        new = self._take()
        if new:
            self._silent_s = 0.0
        else:
            # Time in which the loop was held up does not count: the host may have been, by the same.
            self._silent_s += min(now - before, 2.0 * self._period)
            if self._process.poll() is not None:
                raise RobotFault(f"The robot's host has ended ({_how(self._process.returncode)}): start it anew.")
            if self._silent_s > HUNG_S:
                raise RobotFault(f"The robot's host has not answered for {self._silent_s * 1e3:.0f} ms.")
        report = self._report
        if report.state is None:
            raise RobotFault(report.unreadable)
        return self._known(report.state, report, new)

    def _known(self, state: RobotState, report: Report, new: bool) -> RobotState:
        """Return the state with the host's takeover only where it tells what became of the last write."""
        takeover = state.takeover
        if takeover is None or (new and report.number == self._ask.number and report.arms == self._ask.arms):
            return state
        latched = takeover.latched and report.arms == self._ask.arms
        return _with(state, takeover=Takeover(takeover.rates, True) if latched else None)

    def _take(self) -> bool:
        message = self._reports.get()
        if message is None:
            return False
        self._report = decode_report(message)
        return True

    def write(
        self, base: BaseTwist, joints: tuple[float, ...], gripper: float | None, now: float, deadline: float
    ) -> None:
        """Ask for rates that are good until `deadline` [s]. Raises RobotFault if an earlier write has failed."""
        self._say(now=now, due=deadline, rates=(*self.model.base.rates(base), *joints), gripper=gripper)
        if self._report.failed:
            raise RobotFault(self._report.failed)

    def choose(self, hand: str) -> None:
        """Take the gripper that is written and reported for that of `hand`, from the next write on."""
        self._ask = _with(self._ask, hand=hand)

    def arm(self, now: float) -> None:
        """Let the next write count, though the loop was away from a robot that moved."""
        self._ask = _with(self._ask, arms=self._ask.arms + 1)

    def stop(self, now: float) -> None:
        """Make the robot stand still, and wait for it."""
        self._say(stops=self._ask.stops + 1, rates=())
        self._wait(lambda report: report.stops == self._ask.stops)

    def restart(self, now: float) -> None:
        """Put the robot back to its start, and wait for it."""
        self._say(restarts=self._ask.restarts + 1, rates=())
        if not self._wait(lambda report: report.restarts == self._ask.restarts):
            raise RobotFault("The robot's host did not put it back.")
        if self._report.undone:
            raise RobotFault(self._report.undone)

    def close(self) -> None:
        """End the host: the robot comes to rest first."""
        if self._door >= 0:
            os.close(self._door)
            self._door = -1
            self._asks.close()
            self._reports.close()
        try:
            self._process.wait(END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _say(self, **changes: object) -> None:
        self._ask = _with(self._ask, number=self._ask.number + 1, **changes)
        self._asks.put(encode(self._ask))
        with contextlib.suppress(BlockingIOError, BrokenPipeError):  # it hangs or has ended: `read` says so
            os.write(self._door, b"\0")

    def _wait(self, done: Callable[[Report], bool]) -> bool:
        """Wait until a report says that it is `done`; say whether it does."""
        until = self._clock.now() + DONE_S
        while self._clock.now() < until and self._process.poll() is None:
            if self._take() and done(self._report):
                return True
            self._clock.sleep_until(self._clock.now() + LOOK_S)
        return False


def _how(code: int) -> str:
    return f"signal {-code}" if code < 0 else f"exit code {code}"
