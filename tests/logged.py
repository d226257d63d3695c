"""A robot whose every write is kept in a file, by its driver itself: what reaches the motors, whatever dies."""

from __future__ import annotations

import os
import struct
from pathlib import Path
from typing import NamedTuple

from tests.plugin import install

ENTRY = struct.Struct("<7d")
ROBOTS = '''
import os, struct, time
from overreach.robots.kinematic import KinematicRobot

LOG = os.open(os.environ["ROBOT_LOG"], os.O_WRONLY | os.O_CREAT | os.O_APPEND)
MARK = os.environ["ROBOT_LOG"] + ".mark"

class _Logged:
    """A simulated robot that notes each write with its time."""

    def __init__(self, now):
        self._robot = KinematicRobot(now=now)
        self.model, self.simulated = self._robot.model, True

    def write(self, base, joints, gripper, now, deadline):
        self._robot.write(base, joints, gripper, now, deadline)
        os.write(LOG, struct.pack("<7d", time.monotonic(), now, deadline, base.v_x, base.w_z, *joints))

    def read(self, now): return self._robot.read(now)
    def arm(self, now): self._robot.arm(now)
    def stop(self, now): self._robot.stop(now)
    def restart(self, now): self._robot.restart(now)

class _Hangs(_Logged):
    """Its driver never returns once the mark is there."""

    def read(self, now):
        while os.path.exists(MARK):
            pass
        return self._robot.read(now)

class _Fails(_Logged):
    """Its driver raises on each call that the mark names."""

    def _check(self, what):
        if os.path.exists(MARK) and what in open(MARK).read():
            raise OSError("the cable is out")

    def read(self, now):
        self._check("read")
        return self._robot.read(now)

    def write(self, base, joints, gripper, now, deadline):
        self._check("write")
        super().write(base, joints, gripper, now, deadline)

    def arm(self, now):
        self._check("arm")

    def restart(self, now):
        self._check("restart")
        super().restart(now)

def logged(now): return _Logged(now)
def hanging(now): return _Hangs(now)
def failing(now): return _Fails(now)
def lacking(now): raise OSError("no such device")
def lambdas(now):
    robot = _Logged(now)
    robot.model = lambda: None
    return robot
'''
LAWS = """
import os, time
import overreach as ov

MARK = os.environ["ROBOT_LOG"] + ".mark"

class Stuck(ov.Law, frozen=True):
    name = "stuck"

    def bind(self, model):
        law = ov.Exact().bind(model)

        def share(l, psi, u_r, u_t):
            while os.path.exists(MARK):
                pass
            return law(l, psi, u_r, u_t)

        return share
"""


class Entry(NamedTuple):
    """One write: when it reached the robot, begin of its period, until when it is good [s]; then the rates."""

    at: float
    now: float
    due: float
    v_b: float
    w_b: float
    dtheta_1: float
    dtheta_2: float

    @property
    def rates(self) -> tuple[float, ...]:
        """Rates, channel by channel."""
        return self[3:]


class Log:
    """The folder with the plug-ins, and what was written."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / "writes"
        self.mark = folder / "writes.mark"
        self.env = {
            **install(folder, "robots_of_mine", ROBOTS, "overreach.robots"),
            "ROBOT_LOG": str(self.path),
        }
        install(folder, "stuck_law", LAWS)

    def entries(self) -> list[Entry]:
        """Return all writes up to now."""
        data = self.path.read_bytes() if self.path.exists() else b""
        return [Entry(*one) for one in ENTRY.iter_unpack(data[: len(data) // ENTRY.size * ENTRY.size])]

    def newest(self) -> Entry:
        """Return the newest write."""
        with self.path.open("rb") as file:
            end = file.seek(0, os.SEEK_END) // ENTRY.size * ENTRY.size
            file.seek(end - ENTRY.size)
            return Entry(*ENTRY.unpack(file.read(ENTRY.size)))
