"""The robot side: one tick, top to bottom, at a fixed rate. A clock, a robot and a link around the pilot."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from concurrent.futures import Future
from math import inf
from typing import final

from overreach import __version__
from overreach.clock import Clock
from overreach.control.pilot import Pilot
from overreach.control.tick import Tick
from overreach.errors import OverreachError, SetupError, told
from overreach.link.messages import (
    PROTOCOL,
    Accepted,
    Answer,
    AnyRequest,
    Choice,
    ConfigureRequest,
    Hello,
    Refused,
)
from overreach.link.robot_end import RobotEnd
from overreach.plugs import law_plug
from overreach.requests import RestartRequest
from overreach.robot_side.report import Reporter, welcome
from overreach.robot_side.settings import Builder, Built, blends_to_choose, build, laws_to_choose, usual
from overreach.robots.base import Robot
from overreach.types import RobotState

STATE_PERIOD_S = 1.0 / 60.0
"""A state is sent when a command was accepted, and at the latest after this [s]."""
SLOW_MOST = 3.0
FORGIVEN = 0.1
"""As many decisions as this may take longer than a period; each that does not takes this much of it back."""
HUNG_S = 0.05
"""A decision that takes this long [s] is a fault by itself."""
EXACT = Choice("exact")


def _libraries(law: Choice) -> tuple[str, ...]:
    """Return what decides which libraries a law needs: its name, and what it is told by a name, such as its solver."""
    return law.name, *[value for _, value in sorted(law.parameters.items()) if isinstance(value, str)]


@final
class Loop:
    """Reads robot and link, decides, writes. `tick` lets no exception of a law or robot out; `run` keeps time."""

    def __init__(self, robot: Robot, link: RobotEnd, clock: Clock, rate: float = 200.0, law: Choice = EXACT) -> None:
        self.rate = rate
        self.overruns = 0
        self._robot = robot
        self._link = link
        self._clock = clock
        self._model = robot.model
        self.settings = self._defaults = usual(robot.model, law)
        built = build(self.settings, robot.model)
        self.pilot = Pilot(built.model, built.law)
        self._laws, self._blends = laws_to_choose(), blends_to_choose()
        self._loaded = {_libraries(law)}
        self._builder = Builder()
        self._building: tuple[Future[Built], Callable[[Answer], None]] | None = None
        self._reporter = Reporter()
        self._revision = 0
        self._tick = 0
        self._sent_at = -inf
        self._slow = 0.0

    def run(self, running: Callable[[], bool]) -> None:
        """Tick at `rate` while `running()`. An overrun is counted and the missed ticks are left out.

        However it ends, by `running` or by an exception, the robot ramps to zero first.
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
            self._builder.close()

    def tick(self, now: float, dt: float) -> None:
        """Do one period: robot and link in, the pilot, robot and link out."""
        self._serve(now)
        state = self._read(now)
        command = self._link.newest_command()
        heard = self.pilot.gate.seq
        begun = self._clock.now()
        tick = self.pilot.tick(state, command, now, dt)
        self._watch(self._clock.now() - begun, dt)
        self._write(tick)
        self._tick += 1
        accepted = command is not None and self.pilot.gate.seq == command.seq != heard
        if accepted or now - self._sent_at >= STATE_PERIOD_S:
            self._publish(tick)

    def _read(self, now: float) -> RobotState | None:
        """Return what the robot reports; None, with the fault latched, where it raises."""
        try:
            return self._robot.read(now)
        except Exception as error:  # a driver may raise anything
            self.pilot.fail(f"The robot could not be read: {told(error)}.")
            return None

    def _write(self, tick: Tick) -> None:
        try:
            self._robot.write(tick.base, tick.joints, tick.gripper, tick.now, tick.now + 2.0 * tick.dt)
        except Exception as error:  # as above; what is written next is on the way to zero
            self.pilot.fail(f"The robot could not be written to: {told(error)}.")

    def _watch(self, took: float, dt: float) -> None:
        """Latch a fault where decisions took more than a period, `dt` [s], SLOW_MOST times of late, or HUNG_S once."""
        self._slow = max(0.0, self._slow + (1.0 if took > dt else -FORGIVEN))
        if self._slow >= SLOW_MOST or took > HUNG_S:
            self._slow = 0.0
            law = self.pilot.controller.name
            self.pilot.fail(f"The law {law!r} takes {took * 1e3:.0f} ms; a period has {dt * 1e3:g} ms.")

    def _come_to_rest(self, dt: float) -> None:
        """Ramp to zero by the guard alone, then stop. Whoever watches is told; nobody can hold it up."""
        deadline = self._clock.now()
        moving = True
        try:
            while moving:
                moving = any(self.pilot.controller.guard.written)
                deadline = max(deadline + dt, self._clock.now())  # what was missed is not made up for
                self._clock.sleep_until(deadline)
                tick = self.pilot.ramp(self._clock.now(), dt)
                self._tick += 1
                with contextlib.suppress(Exception):
                    self._write(tick)
                with contextlib.suppress(Exception):
                    self._publish(tick)
        finally:
            with contextlib.suppress(Exception):  # it was written zero already
                self._robot.stop(self._clock.now())

    def _serve(self, now: float) -> None:
        """Carry out what was asked for since the last tick."""
        for hello, answer in self._link.hellos():
            answer(self._welcome(hello))
        if self._building is not None and self._building[0].done():
            self._swap(*self._building)
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

    def _carry_out(self, request: AnyRequest, now: float) -> Answer:
        if isinstance(request, ConfigureRequest):
            raise TypeError("settings are built, not carried out")
        if isinstance(request, RestartRequest) and not self._robot.simulated:
            return Refused("A real robot is not put back.")
        refusal = self.pilot.ask(request, now)
        if refusal:
            return Refused(refusal)
        if isinstance(request, RestartRequest):
            self._robot.restart(now)
        return Accepted()

    def _begin(self, request: ConfigureRequest, answer: Callable[[Answer], None]) -> None:
        """Begin to build other settings beside the loop; raises SetupError where they cannot be used now."""
        settings, resting = request.settings, self.pilot.resting
        if settings.frame is not self.settings.frame and not resting:
            raise SetupError("Let go first: what the stick means does not change in motion.")
        law = settings.law.name
        slow = law in self._laws and law_plug(law).slow_to_load and _libraries(settings.law) not in self._loaded
        if slow and not resting:
            raise SetupError(f"Let go first: {law!r} has to be loaded, which makes the loop late for a moment.")
        if self._building is not None:
            raise SetupError("Other settings are being made ready: try again.")
        self._building = self._builder.begin(settings, self._model), answer

    def _swap(self, future: Future[Built], answer: Callable[[Answer], None]) -> None:
        """Use settings that are ready, or tell why they are not."""
        self._building = None
        try:
            built = future.result()
            self.pilot.configure(built.law, built.model)
            self.pilot.gate.set_speed_scale(built.settings.speed_scale)
        except OverreachError as error:
            answer(Refused(str(error)))
        except BaseException as error:  # a law that is a plug-in may raise anything, where it is imported or made
            self.pilot.fail(f"The robot side met {told(error)}.")
            answer(Refused(f"Fault: the robot side met {told(error)}."))
        else:
            self.settings = built.settings
            self._loaded.add(_libraries(built.settings.law))
            self._revision += 1
            answer(Accepted())

    def _welcome(self, hello: Hello) -> Answer:
        if hello.protocol != PROTOCOL:
            return Refused(
                f"the robot side speaks protocol {PROTOCOL} (overreach {__version__}), the operator side "
                f"{hello.protocol} (overreach {hello.version}): install the same version on both"
            )
        name, choices = self._link.name, (self._laws, self._blends)
        simulated, settings = self._robot.simulated, (self.settings, self._defaults)
        return welcome(self.pilot, *settings, name, self.rate, simulated, *choices, self._revision)

    def _publish(self, tick: Tick) -> None:
        self._sent_at = tick.now
        malformed, revision = self._link.malformed, self._revision
        self._link.publish(self._reporter.state(tick, self.pilot, self._tick, self.overruns, malformed, revision))
