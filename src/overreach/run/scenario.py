"""A scenario that can be run, from a built-in name or a TOML file (see `tables`); every error is one line."""

from __future__ import annotations

import bisect
import importlib.resources
import math
import os
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec

from overreach.arm.mount import Mount
from overreach.errors import ScenarioError, UnknownNameError
from overreach.gate.limits import Limits
from overreach.law.blend import Blend
from overreach.law.frame import of_two
from overreach.law.laws import usual_blend
from overreach.model.model import Model, check_reach, check_workspace
from overreach.model.workspace import Workspace
from overreach.plugs import load_model
from overreach.robots.imperfect import Imperfection
from overreach.run.command import FASTEST, read_commands
from overreach.run.law_table import read_law
from overreach.run.stamps import Segment, fitted
from overreach.run.tables import CommandTable, Dither, Tables, read_tables
from overreach.run.text import read_text
from overreach.types import Frame, Record, Twist

NOTHING = Segment(0.0)
LONGEST_S = 1e6
LIMITS_4 = ("l_min", "l_max", "psi_min", "psi_max")
MOST_STEPS = 20_000_000
"""Longest run: 20,000 s at 1 ms. Above this, dt is more likely mistyped than meant."""


class Scenario(Record, frozen=True):
    """A scenario that can be run. Angles [rad], lengths [m], times [s]. parameters: of laws, by their names."""

    name: str
    description: str
    model: Model
    imperfection: Imperfection
    l: float
    psi: float
    blend: Blend
    parameters: dict[str, dict[str, Any]]
    frame: Frame | None
    duration: float
    dt: float
    segments: tuple[Segment, ...]
    dither: Dither
    limits: Limits | None

    @property
    def steps(self) -> int:
        """Number of control periods."""
        return max(1, round(self.duration / self.dt))

    def segment_at(self, t: float) -> Segment:
        """Return the segment in force at `t` [s]; before the first one, nothing is commanded."""
        k = bisect.bisect_right(self.segments, t + 1e-9 * self.dt, key=lambda segment: segment.t) - 1
        return self.segments[k] if k >= 0 else NOTHING

    def command_at(self, t: float) -> tuple[float, float]:
        """Return the (v_c, w_c) in force at `t` [s], zero before the first segment, plus the tremor."""
        segment = self.segment_at(t)
        v_c, w_c = segment.v_c, segment.w_c
        if self.dither.l == 0.0 and self.dither.psi == 0.0:
            return v_c, w_c
        v, w = self.dither.at(t)
        return v_c + v, w_c + w

    def twist_at(self, t: float, frame: Frame) -> Twist:
        """Return the twist commanded at `t` [s], given in `frame`."""
        planar, rest = of_two(frame, *self.command_at(t)), self.segment_at(t)
        if rest.v_z == rest.w_x == rest.w_y == rest.w_z == 0.0:
            return planar
        return Twist(planar.v_x, planar.v_y, rest.v_z, rest.w_x, rest.w_y, planar.w_z + rest.w_z)

    def on(self, model: Model) -> Scenario:
        """Return the scenario on another robot: places scaled to its workspace, speeds as they are.

        l is scaled linearly from edge to edge, psi by the half width; the sector is the robot's own.
        """
        old, new = self.model.workspace, model.workspace
        l = new.l_min + (self.l - old.l_min) * (new.l_max - new.l_min) / (old.l_max - old.l_min)
        psi = self.psi * (new.psi_max - new.psi_min) / (old.psi_max - old.psi_min)
        return msgspec.structs.replace(
            self, model=model, l=l, psi=min(new.psi_max, max(new.psi_min, psi)), blend=usual_blend(self.blend, model)
        )


def builtin_scenarios() -> dict[str, str]:
    """Return the built-in scenarios: name -> TOML text."""
    folder = importlib.resources.files("overreach.run").joinpath("data")
    return {
        entry.name.removesuffix(".toml"): entry.read_text("utf-8")
        for entry in sorted(folder.iterdir(), key=lambda entry: entry.name)
        if entry.name.endswith(".toml")
    }


def load_scenario(which: str | os.PathLike[str], robot: str = "") -> Scenario:
    """Return the built-in scenario called `which`, or the one in the TOML file `which`.

    robot: another robot to run it on; a built-in scenario is scaled to its workspace, a file's is not. Raises
    ScenarioError (or another SetupError) whose text is one line.
    """
    name = os.fspath(which)
    if not name.endswith(".toml") and os.sep not in name:
        builtin = builtin_scenarios()
        if name not in builtin:
            raise UnknownNameError("scenario", name, builtin, "A file's name must end in .toml.")
        own = parse_scenario(builtin[name], name)
        return own.on(load_model(robot)) if robot else own
    path = Path(name)
    try:
        text = read_text(path)
    except FileNotFoundError:
        choices = ", ".join(builtin_scenarios())
        raise ScenarioError(f"no scenario file {name!r}. Built-in scenarios: {choices}.") from None
    except (OSError, UnicodeDecodeError) as error:
        raise ScenarioError(f"cannot read scenario file {name!r}: {error}") from None
    return parse_scenario(text, path.stem, path.parent, robot)


def parse_scenario(text: str, name: str = "scenario", folder: Path | None = None, robot: str = "") -> Scenario:
    """Return the scenario in TOML `text`; `folder` is where its command file is looked for; robot: not its own."""
    tables = read_tables(text, name)
    if robot:
        tables = msgspec.structs.replace(tables, robot=msgspec.structs.replace(tables.robot, name=robot))
    return _assemble(tables, name, folder or Path())


def _segments(command: CommandTable, name: str, folder: Path) -> tuple[Segment, ...]:
    """Return the commands of the table or of its file, with their times from the run's start."""
    if command.segments == ():
        return ()  # written so: a robot that is to stand still, or a tremor alone
    if command.file is not None:
        what, rows = f"command file {command.file!r}", read_commands(folder / command.file, name)
    else:
        what, rows = "command.segments", command.segments or ()
    for number, (earlier, later) in enumerate(pairwise(rows), start=2):
        if later.t <= earlier.t:
            raise ScenarioError(
                f"scenario {name!r}: command.segments: the time {later.t:g} of entry {number} is not after "
                f"{earlier.t:g} of the one before: the times t must increase from row to row"
            )
    return fitted(rows, command.duration, f"scenario {name!r}: {what}", command.time, command.time_unit)


def _assemble(tables: Tables, name: str, folder: Path) -> Scenario:
    command, robot = tables.command, tables.robot
    if not (command.dt > 0.0 and command.duration > 0.0):
        raise ScenarioError(
            f"scenario {name!r}: command.duration and command.dt must be > 0 s, "
            f"got {command.duration:g} and {command.dt:g}"
        )
    for one in command.segments or ():
        if max(map(abs, (one.v_c, one.w_c, one.v_z, one.w_x, one.w_y, one.w_z))) > FASTEST:
            raise ScenarioError(f"scenario {name!r}: command.segments: velocities must be within +-{FASTEST:g}")
        if one.gripper is not None and not 0.0 <= one.gripper <= 1.0:
            raise ScenarioError(f"scenario {name!r}: command.segments: gripper must be 0 to 1, got {one.gripper:g}")
    if command.duration > LONGEST_S or command.duration / command.dt > MOST_STEPS:
        raise ScenarioError(
            f"scenario {name!r}: more than {LONGEST_S:,.0f} s or {MOST_STEPS:,} steps (duration / dt): "
            "use less time or a greater dt"
        )
    if (command.segments is None) == (command.file is None):
        raise ScenarioError(f"scenario {name!r}: [command] needs either segments or file, one of the two")
    segments = _segments(command, name, folder)

    given = load_model(robot.name)
    own = given.workspace
    asked = tables.workspace
    workspace = Workspace(
        own.l_min if asked.l_min is None else asked.l_min,
        own.l_max if asked.l_max is None else asked.l_max,
        own.psi_min if asked.psi_min is None else asked.psi_min,
        own.psi_max if asked.psi_max is None else asked.psi_max,
    )
    s_x, s_y = robot.shoulder or (given.mount.s_x, given.mount.s_y)
    mount = Mount(s_x, s_y, given.mount.yaw if robot.mount_yaw is None else robot.mount_yaw)
    if own.edges:
        workspace = msgspec.structs.replace(own, **{name: getattr(workspace, name) for name in LIMITS_4})
    model = given.placed(mount, workspace)
    check_workspace(model, workspace)
    start_l = given.start.l if robot.l is None else robot.l
    start_psi = given.start.psi if robot.psi is None else robot.psi
    check_reach(given, start_l)
    if abs(start_psi) > math.pi:
        raise ScenarioError(f"scenario {name!r}: robot.psi must be within +-pi rad, got {start_psi:g}")
    blend, parameters = read_law(tables.law, name)
    if "blend" not in tables.law and not {"q_l", "q_psi"} & set(tables.law):
        blend = usual_blend(blend, model)
    return Scenario(
        name=name,
        description=tables.description,
        model=model,
        imperfection=Imperfection(robot.delay_s, robot.lag_s, robot.noise, robot.seed),
        l=start_l,
        psi=start_psi,
        blend=blend,
        parameters=parameters,
        frame=command.frame,
        duration=command.duration,
        dt=command.dt,
        segments=segments,
        dither=tables.dither,
        limits=tables.limits,
    )
