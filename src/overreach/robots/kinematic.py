"""A robot that moves exactly as velocity-controlled joints and wheels would: no masses, no contact."""

from __future__ import annotations

from typing import final

from overreach.model.handed import hand_of
from overreach.model.model import Model, channels, check_reach
from overreach.plugs import USUAL_MODEL, load_model
from overreach.robots.arc import arc
from overreach.robots.imperfect import Actuators, Imperfection, Sensors
from overreach.types import BaseTwist, Pose, RobotState, Twist

LONGEST_PIECE = 0.005
"""A lagging base turns while its twist changes: it is integrated in pieces of at most this [s]."""


@final
class KinematicRobot:
    """Any model in simulation, by default the built-in one. The base follows exact arcs; joints stop at their limits.

    `true` is the state without measurement noise; `read` gives what a sensor would show.
    """

    simulated = True

    def __init__(
        self,
        model: Model | None = None,
        imperfection: Imperfection | None = None,
        l: float | None = None,
        psi: float | None = None,
        now: float = 0.0,
    ) -> None:
        self.model = model or load_model(USUAL_MODEL)
        self._imperfection = imperfection or Imperfection()
        self._l = self.model.start.l if l is None else l
        self._psi = self.model.start.psi if psi is None else psi
        check_reach(self.model, self._l)
        self._hand = hand_of(self.model)
        self.restart(now)

    def restart(self, now: float) -> None:
        """Put the robot at its start, at rest."""
        self._pose = (0.0, 0.0, 0.0)
        self._joints = self.model.arm.channels
        self._theta = self.model.arm.posture(self._l, self._psi)
        self._actuators = Actuators(len(channels(self.model)), self._imperfection, self.model.base.axes)
        self._now = now
        self._grippers: dict[str, float] = {}
        self._sensors = Sensors(self._imperfection, now, self.model.base.omni)
        self._sensors.see(self.true)

    @property
    def true(self) -> RobotState:
        """The state at the time of the last call, without noise."""
        rates, base = self._actuators.happening, self.model.base
        twist, dq = base.twist(rates), rates[base.axes :]
        motion = Twist(twist.v_x, twist.v_y, w_z=twist.w_z)
        return RobotState(
            self._now, Pose.flat(*self._pose), motion, self._theta, dq, self._grippers.get(self._hand, 0.0)
        )

    def read(self, now: float) -> RobotState:
        """Return the measured state at `now` [s]."""
        self._move_to(now)
        return self._sensors.report(self.true, now)

    def write(
        self, base: BaseTwist, joints: tuple[float, ...], gripper: float | None, now: float, deadline: float
    ) -> None:
        """Ask for a base twist and joint rates from `now` on; they hold, past the deadline too."""
        self._move_to(now)
        self._actuators.ask((*self.model.base.rates(base), *joints), now)
        if gripper is not None:
            self._grippers[self._hand] = max(0.0, min(1.0, gripper))

    def choose(self, hand: str) -> None:
        """Take the gripper that is written and reported for that of `hand`."""
        self._hand = hand

    def arm(self, now: float) -> None:
        """Need nothing to get ready."""

    def stop(self, now: float) -> None:
        """Ask for standstill."""
        self.write(BaseTwist(), (0.0,) * len(self._joints), None, now, now)

    def _move_to(self, end: float) -> None:
        while self._now < end:
            until = self._actuators.next_change(self._now, end)
            if not self._actuators.ideal:
                until = min(until, self._now + LONGEST_PIECE)
            until = self._sensors.due(until)
            dt = until - self._now
            rates, base = self._actuators.advance(dt), self.model.base
            twist, dtheta = base.twist(rates), rates[base.axes :]
            self._pose = arc(*self._pose, twist.v_x, twist.w_z, dt, twist.v_y)
            self._theta = tuple(
                [
                    min(joint.upper, max(joint.lower, angle + rate * dt))
                    for angle, rate, joint in zip(self._theta, dtheta, self._joints, strict=True)
                ]
            )
            self._now = until
            self._sensors.see(self.true)
