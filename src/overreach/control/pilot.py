"""The pilot: gate, frame, whole body, limits, residual, joints and guard, composed once, for every robot and law.

It does no I/O: inputs go in, decisions come out. The loop puts a clock, a robot and a link around it; a simulation, a
stepped clock and a scenario. A recording of its inputs, replayed through a new pilot, gives the same bits.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from overreach.arm.chain import is_aside
from overreach.control.controller import HandController
from overreach.control.tick import Configured, Failed, Tick
from overreach.errors import SetupError
from overreach.gate.gate import MAX_DELAY_S, PLANE, STILL, Gate, Gated
from overreach.gate.limits import Limits
from overreach.law.body import Planner, WholeBody
from overreach.law.frame import frames_of
from overreach.law.usual import usual_law
from overreach.model.handed import hand_of
from overreach.model.model import Model
from overreach.requests import ArmRequest, DisarmRequest, Request, ResetRequest, RestartRequest, StopRequest
from overreach.types import Command, Frame, RobotState
from overreach.verdicts import Motion, Verdict

ROW_OF = {"v_z": 2, "w_x": 3, "w_y": 4}
"""Part of a twist -> the row of `Arm.rows` that it needs. Parts in the plane need no row beyond the plane's."""


def obeys(model: Model) -> frozenset[str]:
    """Return the parts of a twist that the hand of `model` can follow, and "gripper" if it has one."""
    rows = frozenset(name for name, row in ROW_OF.items() if row in model.arm.rows)
    beyond: frozenset[str] = getattr(model.arm, "follows", rows)
    return PLANE | beyond | ({"gripper"} if model.gripper else set())


class Pilot:
    """One operator's command and one robot's state -> what is written, tick by tick. Raises nothing.

    limits: of the command; max_delay [s]: how old a command may be.
    """

    def __init__(
        self,
        model: Model,
        law: WholeBody | None = None,
        limits: Limits | None = None,
        max_delay: float = MAX_DELAY_S,
    ) -> None:
        frames = frozenset(frames_of(model.arm) if is_aside(model.arm) else Frame)
        self.gate = Gate(limits or model.command, obeys=obeys(model), frames=frames, max_delay=max_delay)
        self.controller = self._controller(model, law or usual_law(model))
        self._asked: list[Request | Failed | Configured] = []

    def _controller(self, model: Model, law: WholeBody) -> HandController:
        return HandController(model, law, self.gate.limits.ramp_s)

    @property
    def model(self) -> Model:
        """The robot, with the workspace in force."""
        return self.controller.model

    @property
    def resting(self) -> bool:
        """Say whether the command is zero and the written rates are, too."""
        return self.gate.resting and not any(self.controller.guard.written)

    def ask(self, request: Request, now: float) -> str:
        """Carry out a request at `now` [s]; return "" or, in a sentence for the operator, why it was refused."""
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

    def configure(
        self,
        law: WholeBody,
        model: Model | None = None,
        speed_scale: float | None = None,
        planner: Planner | None = None,
    ) -> None:
        """Change the law and, where they are given, workspace and speed; raises, with nothing changed, where it cannot.

        planner: that of the law for the model, where it has been made before.
        """
        model = model or self.model
        other_hand = hand_of(model) != hand_of(self.model)
        if other_hand and not self.resting:
            raise SetupError("Let go first: another hand is driven only from rest.")
        scale = self.gate.speed_scale if speed_scale is None else speed_scale
        planner = planner or law.planner(model)
        before = self.gate.speed_scale
        self.gate.set_speed_scale(scale)
        try:
            self.controller.configure(law, model, planner)
        except BaseException:
            self.gate.set_speed_scale(before)
            raise
        if other_hand:
            self.gate.forget()
        self._asked.append(Configured(law, model, scale, planner))

    def fail(self, reason: str) -> None:
        """Latch a fault for `reason`: the robot ramps to zero. The first reason stays until the fault is reset."""
        self._asked.append(Failed(reason))
        self.controller.guard.latch(reason)
        self.gate.latch.fail(reason)

    def tick(self, state: RobotState | None, command: Command | None, now: float, dt: float) -> Tick:
        """Decide the period `dt` [s] that begins at `now` [s], and return all of it.

        state: what the robot reports, or None; command: the newest message that came since the last tick, or None.
        """
        takeover = getattr(state, "takeover", None)  # a plug-in driver may report anything
        if takeover is not None and self.controller.go_on(takeover):
            self.gate.pause()
        gated = self._gated(command, now, dt)
        decided = self.controller.decide(state, gated.twist, dt, now, gated.motion, gated.frame)
        if decided.fault:
            self.gate.latch.fail(decided.fault)
        requests: tuple[Request | Failed | Configured, ...] = ()
        if self._asked:
            requests, self._asked = tuple(self._asked), []
        latch = self.gate.latch
        return Tick(now, dt, state, command, requests, gated, decided, latch.armed, latch.latched, latch.operator)

    def _gated(self, command: Command | None, now: float, dt: float) -> Gated:
        if command is not None:
            self.gate.accept(command, now)
        return self.gate.tick(now, dt)

    def ramp(self, now: float, dt: float) -> Tick:
        """Return the next tick of the ramp to zero, without state, command or law. Used at the end of every run."""
        gated = Gated(STILL, self.controller.frame, None, 1.0, Motion.NONE, Verdict.ENDING)
        latch = self.gate.latch
        decided = self.controller.ramp(dt)
        return Tick(now, dt, None, None, (), gated, decided, latch.armed, latch.latched, latch.operator)


def replay(pilot: Pilot, ticks: Iterable[Tick]) -> Iterator[Tick]:
    """Feed the inputs of recorded ticks to a new `pilot`; yield its ticks, which are the same bit for bit."""
    for tick in ticks:
        for request in tick.requests:
            match request:
                case Failed(reason):
                    pilot.fail(reason)
                case Configured(law, model, speed_scale, planner):
                    pilot.configure(law, model, speed_scale, planner)
                case _:
                    pilot.ask(request, tick.now)
        yield pilot.tick(tick.state, tick.command, tick.now, tick.dt)
