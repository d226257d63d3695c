"""The pilot: gate, frame, whole body, limits, residual, joints and guard, composed once, for every robot and law.

Sans-I/O: what it is told goes in, what it decides comes out. The loop puts a clock, a robot and a link around it, a
simulation a stepped clock and a scenario; and a recording of its inputs, played through a new one, gives the same bits.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from overreach.control.controller import HandController
from overreach.control.tick import Tick
from overreach.gate.gate import PLANE, STILL, Gate, Gated
from overreach.gate.limits import Limits
from overreach.law.body import WholeBody
from overreach.law.laws import Exact
from overreach.model.model import Model
from overreach.requests import ArmRequest, DisarmRequest, Request, ResetRequest, RestartRequest, StopRequest
from overreach.types import Command, RobotState
from overreach.verdicts import Motion, Verdict

ROW_OF = {"v_z": 2, "w_x": 3, "w_y": 4}
"""Which row of an arm a part of the twist needs; the others are the plane's, and need none beyond it."""


def obeys(model: Model) -> frozenset[str]:
    """Return the parts of a twist that the hand of `model` can do, and "gripper" where it has one."""
    beyond = {name for name, row in ROW_OF.items() if row in model.arm.rows}
    return PLANE | beyond | ({"gripper"} if model.gripper else set())


class Pilot:
    """One operator's command and one robot's state -> what is written, tick by tick. Raises nothing.

    limits: of the command.
    """

    def __init__(self, model: Model, law: WholeBody | None = None, limits: Limits | None = None) -> None:
        self.gate = Gate(limits, obeys=obeys(model))
        self.controller = self._controller(model, law or Exact())
        self._asked: list[Request] = []

    def _controller(self, model: Model, law: WholeBody) -> HandController:
        return HandController(model, law, self.gate.limits.ramp_s)

    @property
    def model(self) -> Model:
        """The robot, with the workspace in force."""
        return self.controller.model

    @property
    def resting(self) -> bool:
        """Say whether the command is zero, and what is written as well."""
        return self.gate.resting and not any(self.controller.guard.written)

    def ask(self, request: Request, now: float) -> str:
        """Carry out a request at `now` [s]; return why not, in a sentence for the operator, or ""."""
        self._asked.append(request)
        latch = self.gate.latch
        match request:
            case StopRequest():
                latch.stop()
            case ResetRequest():
                latch.reset()
                self.controller.reset()
            case DisarmRequest(operator):
                if latch.armed and operator != latch.operator:
                    return "Another operator has armed the robot. Stop is always possible."
                latch.disarm()
            case ArmRequest(operator, grip):
                match self.gate.arm(operator, grip, now):
                    case Verdict.STOPPED | Verdict.FAULT as why:
                        return f"{why.word}: press Reset first."
                    case Verdict.OTHER_OPERATOR:
                        return "Another operator is driving. Stop is always possible."
            case RestartRequest():
                if latch.armed or not self.resting:
                    return "Disarm first, and wait until the robot stands still."
                self.controller.restart()
        return ""

    def configure(self, law: WholeBody, model: Model | None = None) -> None:
        """Change the law, and where it is given the workspace; raises, with nothing changed, where it cannot be."""
        self.controller.configure(law, model)

    def fail(self, reason: str) -> None:
        """Latch a fault for `reason`: the robot ramps to zero. The first one stays, until it is reset."""
        self.controller.guard.latch(reason)
        self.gate.latch.fail(reason)

    def tick(self, state: RobotState | None, command: Command | None, now: float, dt: float) -> Tick:
        """Return all of the period `dt` [s] that begins at `now` [s].

        state: what the robot reports, None where it reports nothing; command: the newest message that came since the
        last tick, None where none did.
        """
        gated = self._gated(command, now, dt)
        decided = self.controller.decide(state, gated.twist, dt, now, gated.motion, gated.frame)
        if decided.fault:
            self.gate.latch.fail(decided.fault)
        requests: tuple[Request, ...] = ()
        if self._asked:
            requests, self._asked = tuple(self._asked), []
        latch = self.gate.latch
        return Tick(now, dt, state, command, requests, gated, decided, latch.armed, latch.latched, latch.operator)

    def _gated(self, command: Command | None, now: float, dt: float) -> Gated:
        if command is not None:
            self.gate.accept(command, now)
        return self.gate.tick(now, dt)

    def ramp(self, now: float, dt: float) -> Tick:
        """Return the next period on the way to zero: without state, command or law. For the end of every run."""
        gated = Gated(STILL, self.controller.frame, None, 1.0, Motion.NONE, Verdict.ENDING)
        latch = self.gate.latch
        decided = self.controller.ramp(dt)
        return Tick(now, dt, None, None, (), gated, decided, latch.armed, latch.latched, latch.operator)


def replay(pilot: Pilot, ticks: Iterable[Tick]) -> Iterator[Tick]:
    """Yield what `pilot`, which is new, makes of the inputs of recorded ticks: the same, bit for bit."""
    for tick in ticks:
        for request in tick.requests:
            pilot.ask(request, tick.now)
        yield pilot.tick(tick.state, tick.command, tick.now, tick.dt)
