"""The robot side: one tick, top to bottom, at a fixed rate."""

from __future__ import annotations

import contextlib
import gc
from collections.abc import Callable
from math import inf
from typing import final

from overreach import __version__
from overreach.arm.polar import hand_in_world
from overreach.clock import Clock
from overreach.control.controller import HandController
from overreach.errors import OverreachError, SetupError, told
from overreach.gate.gate import STALE_S, Gate, Gated
from overreach.law.blend import Step as HardSwitch
from overreach.law.body import WholeBody
from overreach.link.messages import (
    PROTOCOL,
    Accepted,
    Answer,
    Arm,
    Configure,
    Disarm,
    Hello,
    Refused,
    Request,
    Reset,
    Restart,
    Settings,
    State,
    Stop,
    Welcome,
)
from overreach.link.robot_end import RobotEnd
from overreach.model.model import Model, check_workspace, placed
from overreach.model.workspace import Workspace
from overreach.parameters import schema
from overreach.plugs import BODIES, LAWS, blend_plug, load_law, loaded, names
from overreach.robots.kinematic import KinematicRobot
from overreach.timing import Lateness
from overreach.types import Motion, RobotState, Step, Verdict, weightier

STATE_PERIOD_S = 1.0 / 60.0
"""A state is sent when a stick was accepted, and at the latest after this [s]."""
SLOW_MOST = 3.0
FORGIVEN = 0.1
"""As many decisions as this may take longer than a period; each that does not takes this much of it back."""
HUNG_S = 0.05
"""A decision that takes this long [s] is a fault by itself."""


@final
class Loop:
    """Reads robot and link, decides, writes. `tick` lets no exception of a law or robot out; `run` keeps time."""

    def __init__(self, model: Model, robot: KinematicRobot, link: RobotEnd, clock: Clock, rate: float = 200.0) -> None:
        self.model = model
        self.rate = rate
        self.gate = Gate()
        self.late = Lateness()
        self.overruns = 0
        self._robot = robot
        self._link = link
        self._clock = clock
        space = model.workspace
        self.settings = Settings(l_min=space.l_min, l_max=space.l_max, psi_min=space.psi_min, psi_max=space.psi_max)
        self.controller = HandController(
            model, self._law(self.settings), self.settings.frame, ramp_s=self.gate.limits.ramp_s
        )
        self._defaults = self.settings
        self._revision = 0
        self._tick = 0
        self._sent_at = -inf
        self._told = (0.0, 0.0, 0.0)
        self._told_at = -inf
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
                self.late.add(now - deadline)
                self.tick(now, period)
                deadline += period
                if (behind := self._clock.now() - deadline) > 0.0:
                    missed = int(behind / period) + 1
                    self.overruns += missed
                    deadline += missed * period
        finally:
            self._come_to_rest(period)

    def tick(self, now: float, dt: float) -> None:
        """Do one period: robot and link in, gate, law, arm and guard, robot and link out."""
        self._serve(now)
        state = self._read(now)
        stick = self._link.newest_stick()
        refusal = self.gate.accept(stick, now) if stick else None
        gated = self.gate.tick(now, dt)
        begun = self._clock.now()
        step = self.controller.step(state, gated.v_c, gated.w_c, dt, now, gated.motion)
        self._watch(self._clock.now() - begun, dt)
        self._write(step, now)
        if self.controller.guard.fault:
            self.gate.latch.fail(self.controller.guard.fault)
        self._tick += 1
        if (stick and not refusal) or now - self._sent_at >= STATE_PERIOD_S:
            self._publish(now, gated, step)

    def _read(self, now: float) -> RobotState | None:
        """Return what the robot reports; None, with the fault latched, where it raises."""
        try:
            return self._robot.read(now)
        except Exception as error:  # a driver may raise anything
            self.controller.guard.latch(f"The robot could not be read: {told(error)}.")
            return None

    def _write(self, step: Step, now: float) -> None:
        try:
            self._robot.write(step.twist, step.dtheta, now)
        except Exception as error:  # as above; what is written next is on the way to zero
            self.controller.guard.latch(f"The robot could not be written to: {told(error)}.")

    def _watch(self, took: float, dt: float) -> None:
        """Latch a fault where decisions took more than a period, `dt` [s], SLOW_MOST times of late, or HUNG_S once."""
        self._slow = max(0.0, self._slow + (1.0 if took > dt else -FORGIVEN))
        if self._slow >= SLOW_MOST or took > HUNG_S:
            self._slow = 0.0
            law = self.controller.name
            self.controller.guard.latch(f"The law {law!r} takes {took * 1e3:.0f} ms; a period has {dt * 1e3:g} ms.")

    def _come_to_rest(self, dt: float) -> None:
        """Ramp to zero by the guard alone, then stop. Whoever watches is told; nobody can hold it up."""
        gated = Gated(0.0, 0.0, 1.0, Motion.NONE, Verdict.ENDING)
        deadline = self._clock.now()
        moving = True
        try:
            while moving:
                moving = any(self.controller.guard.written)
                deadline = max(deadline + dt, self._clock.now())  # what was missed is not made up for
                self._clock.sleep_until(deadline)
                step = self.controller.ramp(dt)
                self._write(step, deadline)
                self._tick += 1
                with contextlib.suppress(Exception):
                    self._publish(deadline, gated, step)
        finally:
            with contextlib.suppress(Exception):  # it was written zero already
                self._robot.stop(self._clock.now())

    @property
    def resting(self) -> bool:
        """Say whether the command is zero, and what is written as well."""
        return self.gate.resting and not any(self.controller.guard.written)

    def _serve(self, now: float) -> None:
        """Carry out what was asked for since the last tick."""
        for hello, answer in self._link.hellos():
            answer(self._welcome(hello))
        for request, answer in self._link.requests():
            try:
                answer(self._carry_out(request, now))
            except OverreachError as error:
                answer(Refused(str(error)))
            except Exception as error:  # a law that is a plug-in may raise anything: the loop goes on
                self.controller.guard.latch(f"The robot side met {told(error)}.")
                answer(Refused(f"Fault: the robot side met {told(error)}."))

    def _carry_out(self, request: Request, now: float) -> Answer:
        latch = self.gate.latch
        match request:
            case Stop():
                latch.stop()
            case Reset():
                latch.reset()
                self.controller.reset()
            case Disarm(operator):
                if latch.armed and operator != latch.operator:
                    return Refused("Another operator has armed the robot. Stop is always possible.")
                latch.disarm()
            case Arm(operator, grip):
                match self.gate.arm(operator, grip, now):
                    case Verdict.STOPPED | Verdict.FAULT as why:
                        return Refused(f"{why.word}: press Reset first.")
                    case Verdict.OTHER_OPERATOR:
                        return Refused("Another operator is driving. Stop is always possible.")
            case Restart():
                if latch.armed or not self.resting:
                    return Refused("Disarm first, and wait until the robot stands still.")
                self._robot.restart(now)
                self.controller.restart()
            case Configure(settings):
                self._configure(settings)
        return Accepted()

    def _law(self, settings: Settings) -> WholeBody:
        plug = blend_plug(settings.blend)
        own = {one.name: getattr(settings, one.name) for one in schema(plug)}
        return load_law(settings.law, {}, plug.made(own, "blend"))

    def _model(self, settings: Settings) -> Model:
        """Return the robot with the workspace of `settings`."""
        workspace = Workspace(settings.l_min, settings.l_max, settings.psi_min, settings.psi_max)
        model = placed(self.model, self.model.mount, workspace)
        check_workspace(model, workspace)
        return model

    def _configure(self, settings: Settings) -> None:
        """Use `settings`; raises SetupError, with nothing changed, where they cannot be used."""
        if settings.frame is not self.controller.frame and not self.resting:
            raise SetupError("Let go first: what the stick means does not change in motion.")
        new = settings.law in names(LAWS, BODIES) and not loaded(settings.law)
        if new and not self.resting:
            raise SetupError(f"Let go first: {settings.law!r} has to be loaded, which holds the loop up for a moment.")
        law, model, frame = self._law(settings), self._model(settings), settings.frame
        if new:  # what came with it is here to stay: the collector is not to look through it in the middle of a drive
            gc.collect()
            gc.freeze()
        before = self.gate.speed_scale
        self.gate.set_speed_scale(settings.speed_scale)
        try:
            self.controller.configure(law, frame, model)
        except Exception:
            self.gate.set_speed_scale(before)
            raise
        self.settings = settings
        self._revision += 1

    def _welcome(self, hello: Hello) -> Answer:
        if hello.protocol != PROTOCOL:
            return Refused(
                f"the robot side speaks protocol {PROTOCOL} (overreach {__version__}), the operator side "
                f"{hello.protocol} (overreach {hello.version}): install the same version on both"
            )
        base, limits = self.model.base, self.gate.limits
        return Welcome(
            protocol=PROTOCOL,
            version=__version__,
            robot=self.model.name,
            rate=self.rate,
            links=self.model.arm.links,  # type: ignore[attr-defined]
            shoulder=(self.model.mount.s_x, self.model.mount.s_y),
            mount_yaw=self.model.mount.yaw,
            footprint=base.footprint,
            v_max=limits.v_c,
            w_max=limits.w_c,
            stop_time=STALE_S + 1.0 / self.rate + self.controller.guard.stop_s,
            simulated=True,
            settings=self.settings,
            defaults=self._defaults,
            revision=self._revision,
        )

    def _publish(self, now: float, gated: Gated, step: Step) -> None:
        self._sent_at = now
        self._link.publish(self._report(now, gated, step))

    def _report(self, now: float, gated: Gated, step: Step) -> State:
        verdict = weightier(gated.verdict, step.verdict)
        latch, state = self.gate.latch, step.state
        sentence = verdict.sentence
        if verdict is Verdict.FAULT:
            sentence = f"{step.fault or latch.fault} {sentence}"
        if now - self._told_at >= 1.0:
            self._told = (self.late.percentile(0.5), self.late.percentile(0.99), self.late.most * 1e6)
            self._told_at = now
            self.late.reset()
        mount, split, polar = self.model.mount, step.split, step.polar
        x_e, y_e = hand_in_world(
            state.x_b, state.y_b, state.theta_b, polar.l, polar.psi + mount.yaw, mount.s_x, mount.s_y
        )
        blend = getattr(self.controller.law, "blend", HardSwitch())
        return State(
            now, self._tick, latch.operator, self.gate.seq, verdict.value, verdict.word, sentence,
            gated.scale * step.scale, latch.armed, latch.latched, gated.v_c, gated.w_c,
            polar.l, polar.psi, polar.theta_e, split.mu, split.sigma, split.v_b, split.w_b, split.v_m, split.w_m,
            state.x_b, state.y_b, state.theta_b, state.theta[0], state.theta[1], x_e, y_e,
            *self._told, self.overruns, self.gate.refused + self._link.malformed, self._revision,
            blend.width_l, blend.width_psi, verdict.look,
        )  # fmt: skip
