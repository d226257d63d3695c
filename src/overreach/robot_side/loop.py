"""The robot side: one tick, top to bottom, at a fixed rate. A clock, a robot and a link around the pilot."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from concurrent.futures import Future
from math import inf
from typing import NamedTuple, cast, final

import msgspec

from overreach import __version__
from overreach.clock import Clock
from overreach.control.pilot import Pilot
from overreach.control.tick import Tick
from overreach.errors import OverreachError, SetupError, told
from overreach.gate.gate import MAX_DELAY_S
from overreach.law.usual import usual_law
from overreach.link.messages import (
    PROTOCOL,
    Accepted,
    Answer,
    Choice,
    ConfigureRequest,
    Hello,
    Refused,
    Settings,
    encode,
)
from overreach.link.robot_end import RobotEnd
from overreach.model.handed import hands_of
from overreach.plugs import law_plug
from overreach.requests import ArmRequest, Request, RestartRequest
from overreach.robot_side.report import Reporter
from overreach.robot_side.settings import Builder, Built, build, usual
from overreach.robot_side.welcome import Reception
from overreach.robots.base import Handed, Robot, sentence
from overreach.types import Command, RobotState

STATE_PERIOD_S = 1.0 / 60.0
"""A state is sent when a command is accepted, and at the latest this long [s] after the last one."""
SLOW_MOST = 3.0
FORGIVEN = 0.1
"""A decision longer than a period adds 1 to a count; any other takes FORGIVEN off it. At SLOW_MOST it is a fault."""
HUNG_S = 0.05
"""A decision that takes this long [s] is a fault by itself."""
GOOD_PERIODS = 2.0
"""What is written is good for this many periods: then the robot's host, if it has one, ramps to zero."""
USUAL = Choice("")
"""The law that suits the robot."""


def _libraries(law: Choice) -> tuple[str, ...]:
    """Return what decides which libraries a law needs: its name and its text parameters, such as its solver."""
    return law.name, *[value for _, value in sorted(law.parameters.items()) if isinstance(value, str)]


class Building(NamedTuple):
    """Settings that are being made ready: which, what becomes of them, who is told, whether it may take a while."""

    settings: Settings
    future: Future[Built]
    answer: Callable[[Answer], None]
    slow: bool


def _of_another(hello: Hello) -> Refused:
    """Return the answer to an operator's side that speaks another protocol."""
    return Refused(
        f"the robot side speaks protocol {PROTOCOL} (overreach {__version__}), the operator side "
        f"{hello.protocol} (overreach {hello.version}): install the same version on both"
    )


@final
class Loop:
    """Reads robot and link, decides, writes. `tick` lets no exception of a law or robot out; `run` keeps time."""

    def __init__(
        self,
        robot: Robot,
        link: RobotEnd,
        clock: Clock,
        rate: float = 200.0,
        law: Choice = USUAL,
        max_delay: float = MAX_DELAY_S,
    ) -> None:
        self.rate = rate
        self.overruns = 0
        self._robot = robot
        self._link = link
        self._clock = clock
        self._model = robot.model
        law = law if law.name else msgspec.structs.replace(law, name=usual_law(robot.model).name)
        if hands_of(robot.model) and not hasattr(robot, "choose"):
            raise SetupError(f"the robot {robot.model.name} has several hands, and its driver has no `choose`")
        built = build(usual(robot.model, law), robot.model)
        self.settings = built.settings
        self.pilot = Pilot(built.model, built.law, max_delay=max_delay)
        self._reception = Reception(self.pilot, link.name, rate, robot.simulated, self.settings)
        self._reception.take(built)
        self._loaded = {_libraries(law)}
        self._builder = Builder()
        self._building: Building | None = None
        self._reporter = Reporter()
        self._tick = 0
        self._sent_at = -inf
        self._slow = 0.0

    def run(self, running: Callable[[], bool]) -> None:
        """Tick at `rate` while `running()`. Overruns are counted and missed ticks are skipped.

        However it ends, by `running` or by an exception, the robot first ramps to zero.
        """
        period = 1.0 / self.rate
        deadline = self._clock.now() + period
        try:
            while running():
                self._clock.sleep_until(deadline)
                now = self._clock.now()
                self._reporter.late.add(now - deadline)
                self.tick(now, period)
                deadline += period
                if (behind := self._clock.now() - deadline) > 0.0:
                    missed = int(behind / period) + 1
                    self.overruns += missed
                    deadline += missed * period
        finally:
            self._come_to_rest(period)

    def tick(self, now: float, dt: float) -> None:
        """Run one period: read robot and link, decide, write to both."""
        self._serve(now)
        state = self._read(now)
        command = self._link.newest_command(self.pilot.gate.latch.operator)
        if command is not None and self._building is not None and self._building.slow:
            self._spend(command, now)
        heard = self.pilot.gate.seq
        begun = self._clock.now()
        tick = self.pilot.tick(state, command, now, dt)
        self._watch(self._clock.now() - begun, dt)
        self._write(tick)
        self._tick += 1
        accepted = command is not None and self.pilot.gate.seq == command.seq != heard
        if accepted or now - self._sent_at >= STATE_PERIOD_S:
            self._publish(tick)

    def _spend(self, command: Command, now: float) -> None:
        """Arm anew for who drives: while libraries load, which makes the loop late, a press does not count."""
        latch = self.pilot.gate.latch
        if latch.armed and latch.operator == command.operator:
            self.pilot.ask(ArmRequest(command.operator, command.grip), now)

    def _read(self, now: float) -> RobotState | None:
        """Return what the robot reports; None, with the fault latched, where it raises."""
        try:
            return self._robot.read(now)
        except Exception as error:  # a driver may raise anything
            self.pilot.fail(sentence("read", error))
            return None

    def _write(self, tick: Tick) -> None:
        now = self._clock.now()
        self._reporter.wrote(now, tick.dt)
        try:
            self._robot.write(tick.base, tick.joints, tick.gripper, tick.now, now + GOOD_PERIODS * tick.dt)
        except Exception as error:  # as above; what is written next is on the way to zero
            self.pilot.fail(sentence("written to", error))

    def _watch(self, took: float, dt: float) -> None:
        """Latch a fault if decisions recently took more than a period `dt` [s] SLOW_MOST times, or HUNG_S once."""
        self._slow = max(0.0, self._slow + (1.0 if took > dt else -FORGIVEN))
        if self._slow >= SLOW_MOST or took > HUNG_S:
            self._slow = 0.0
            law = self.pilot.controller.name
            self.pilot.fail(f"The law {law!r} takes {took * 1e3:.0f} ms; a period has {dt * 1e3:g} ms.")

    def _come_to_rest(self, dt: float) -> None:
        """Ramp to zero by the guard alone, then stop. States are still published; no exception can hold it up."""
        deadline = self._clock.now()
        moving = True
        try:
            while moving:
                moving = any(self.pilot.controller.guard.written)
                deadline = max(deadline + dt, self._clock.now())  # missed periods are not made up for
                self._clock.sleep_until(deadline)
                tick = self.pilot.ramp(self._clock.now(), dt)
                self._tick += 1
                with contextlib.suppress(Exception):
                    self._write(tick)
                with contextlib.suppress(Exception):
                    self._publish(tick)
        finally:
            with contextlib.suppress(Exception):  # zero was written already
                self._robot.stop(self._clock.now())

    def _serve(self, now: float) -> None:
        """Carry out what was asked for since the last tick."""
        for hello, greet in self._link.hellos():
            greet(self._reception.welcome if hello.protocol == PROTOCOL else _of_another(hello))
        if self._building is not None and self._building.future.done():
            self._swap(self._building)
        for request, answer in self._link.requests():
            try:
                if isinstance(request, ConfigureRequest):
                    self._begin(request, answer)
                else:
                    answer(self._carry_out(request, now))
            except OverreachError as error:
                answer(Refused(str(error)))
            except Exception as error:  # a driver may raise anything: the loop goes on
                self.pilot.fail(f"The robot side met {told(error)}.")
                answer(Refused(f"Fault: the robot side met {told(error)}."))

    def _carry_out(self, request: Request, now: float) -> Answer:
        if isinstance(request, RestartRequest) and not self._robot.simulated:
            return Refused("A real robot is not put back.")
        refusal = self.pilot.ask(request, now)
        if refusal:
            return Refused(refusal)
        calls = {RestartRequest: ("put back", self._robot.restart), ArmRequest: ("armed", self._robot.arm)}
        if type(request) in calls:
            did, call = calls[type(request)]
            try:
                call(now)
            except Exception as error:  # a driver may raise anything
                self.pilot.fail(why := sentence(did, error))
                return Refused(f"Fault: {why}")
        return Accepted()

    def _begin(self, request: ConfigureRequest, answer: Callable[[Answer], None]) -> None:
        """Begin to build new settings beside the loop; raises SetupError if they cannot be used now."""
        settings, resting = request.settings, self.pilot.resting
        if self._building is not None and self._building.settings == settings:  # asked for again
            self._building = self._building._replace(answer=answer)
            return
        if settings.frame is not self.settings.frame and not resting:
            raise SetupError("Let go first: what the stick means does not change in motion.")
        if settings.hand != self.settings.hand and not resting:
            raise SetupError("Let go first: another hand is driven only from rest.")
        law = settings.law.name
        slow = (
            law in self._reception.laws and law_plug(law).slow_to_load and _libraries(settings.law) not in self._loaded
        )
        if slow and not resting:
            raise SetupError(f"Let go first: {law!r} has to be loaded, which makes the loop late for a moment.")
        if self._building is not None:
            raise SetupError("Other settings are being made ready: try again.")
        self._building = Building(
            settings, self._builder.begin(settings, self._model, self.settings.hand), answer, slow
        )

    def _swap(self, building: Building) -> None:
        """Put finished settings into force, or answer why they cannot be used."""
        self._building = None
        try:
            built = building.future.result()
            if built.settings.hand != self.settings.hand:
                self._choose(built)
            else:
                self.pilot.configure(built.law, built.model, built.settings.speed_scale, built.planner)
        except OverreachError as error:
            building.answer(Refused(str(error)))
        except BaseException as error:  # a plug-in law may raise anything when it is imported or made
            self.pilot.fail(f"The robot side met {told(error)}.")
            building.answer(Refused(f"Fault: the robot side met {told(error)}."))
        else:
            self.settings = built.settings
            self._loaded.add(_libraries(built.settings.law))
            self._reception.take(built)
            building.answer(Accepted())

    def _choose(self, built: Built) -> None:
        """Drive another hand. Where that fails, the one that was driven stays."""
        robot, before = cast(Handed, self._robot), self.settings.hand
        robot.choose(built.settings.hand)
        try:
            self.pilot.configure(built.law, built.model, built.settings.speed_scale, built.planner)
        except BaseException:
            robot.choose(before)
            raise

    def _publish(self, tick: Tick) -> None:
        """Tell of a tick; what cannot be sent, of an arm or robot that is a plug-in, is a fault."""
        self._sent_at = tick.now
        malformed, revision = self._link.malformed, self._reception.revision
        try:
            frame = self.settings.frame
            state = encode(
                self._reporter.state(tick, self.pilot, self._tick, self.overruns, malformed, revision, frame)
            )
        except Exception as error:
            self.pilot.fail(f"The robot's state cannot be told: {told(error)}.")
            return
        self._link.publish(state)
