"""What a scenario file may say. TOML in, a checked `Scenario` out; every error is one line.

[robot]      name = "planar", l = 0.65, psi = 0.0, shoulder = [0.0, 0.0], mount_yaw = 0.0,
             delay_s, lag_s, noise, seed (of the actuators and encoders; all 0)
[workspace]  l_min, l_max, psi_min, psi_max
[law]        blend = "tanh"|"smoothstep"|"step", and its parameters: alpha, beta (tanh), q_l, q_psi (smoothstep)
[law.NAME]   parameters of the law NAME, where the scenario is run with it: [law.weighted] base_weight = 2.0
[command]    duration, dt, frame, and either segments = [{t, v_c, w_c}, ...] or file = "x.csv" (t,v_c,w_c)
[dither]     l, psi, f: a tremor added to the command, as swings of the hand [m, rad] at f [Hz]
[limits]     v_c, w_c, dv_c, dw_c: without this table nothing is limited, to show the law alone
"""

from __future__ import annotations

import bisect
import importlib.resources
import math
import os
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec

from overreach.arm.mount import Mount
from overreach.errors import ScenarioError, UnknownNameError
from overreach.gate.limits import Limits
from overreach.law.blend import Blend
from overreach.model.model import Model, check_reach, check_workspace
from overreach.model.workspace import Workspace
from overreach.plugs import load_model
from overreach.robots.imperfect import Imperfection
from overreach.run.command import FASTEST, Segment, read_commands
from overreach.run.law_table import read_law
from overreach.types import Frame, Record

LONGEST_S = 1e6
MOST_STEPS = 20_000_000
"""Longest run: 20,000 s at 1 ms. Above this, dt is more likely mistyped than meant."""


class RobotTable(Record, frozen=True):
    """The table [robot]: l [m], psi [rad] of the hand at the start, shoulder [m], mount_yaw [rad]."""

    name: str = "planar"
    l: float | None = None
    psi: float | None = None
    shoulder: tuple[float, float] | None = None
    mount_yaw: float | None = None
    delay_s: float = 0.0
    lag_s: float = 0.0
    noise: float = 0.0
    seed: int = 0


class WorkspaceTable(Record, frozen=True):
    """The table [workspace]; a limit that is left out is the robot's own."""

    l_min: float | None = None
    l_max: float | None = None
    psi_min: float | None = None
    psi_max: float | None = None


class CommandTable(Record, frozen=True):
    """The table [command]."""

    duration: float
    dt: float = 0.001
    frame: Frame | None = None
    segments: tuple[Segment, ...] | None = None
    file: str | None = None


class Dither(Record, frozen=True):
    """The table [dither]: a tremor that makes l and psi swing by +-l [m] and +-psi [rad] at f [Hz]."""

    l: float = 0.0
    psi: float = 0.0
    f: float = 1.0

    def at(self, t: float) -> tuple[float, float]:
        """Return what it adds to (v_c, w_c) at `t` [s]: 2 pi f a cos(2 pi f t)."""
        rate = 2.0 * math.pi * self.f
        swing = rate * math.cos(rate * t)
        return self.l * swing, self.psi * swing


class Tables(Record, frozen=True):
    """A scenario file, table by table."""

    command: CommandTable
    description: str = ""
    robot: RobotTable = RobotTable()
    workspace: WorkspaceTable = WorkspaceTable()
    law: dict[str, Any] = {}
    dither: Dither = Dither()
    limits: Limits | None = None


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

    def command_at(self, t: float) -> tuple[float, float]:
        """Return the (v_c, w_c) in force at `t` [s], zero before the first segment, plus the tremor."""
        k = bisect.bisect_right(self.segments, t + 1e-9 * self.dt, key=lambda segment: segment.t) - 1
        v_c, w_c = (self.segments[k].v_c, self.segments[k].w_c) if k >= 0 else (0.0, 0.0)
        if self.dither.l == 0.0 and self.dither.psi == 0.0:
            return v_c, w_c
        v, w = self.dither.at(t)
        return v_c + v, w_c + w


def builtin_scenarios() -> dict[str, str]:
    """Return the built-in scenarios: name -> TOML text."""
    folder = importlib.resources.files("overreach.run").joinpath("data")
    return {
        entry.name.removesuffix(".toml"): entry.read_text("utf-8")
        for entry in sorted(folder.iterdir(), key=lambda entry: entry.name)
        if entry.name.endswith(".toml")
    }


def load_scenario(which: str | os.PathLike[str]) -> Scenario:
    """Return the built-in scenario called `which`, or the one in the TOML file `which`.

    Raises ScenarioError (or another SetupError) whose text is one line.
    """
    name = os.fspath(which)
    if not name.endswith(".toml") and os.sep not in name:
        builtin = builtin_scenarios()
        if name not in builtin:
            raise UnknownNameError("scenario", name, builtin, "A file's name must end in .toml.")
        return parse_scenario(builtin[name], name)
    path = Path(name)
    try:
        text = path.read_text("utf-8")
    except FileNotFoundError:
        choices = ", ".join(builtin_scenarios())
        raise ScenarioError(f"no scenario file {name!r}. Built-in scenarios: {choices}.") from None
    except (OSError, UnicodeDecodeError) as error:
        raise ScenarioError(f"cannot read scenario file {name!r}: {error}") from None
    return parse_scenario(text, path.stem, path.parent)


def parse_scenario(text: str, name: str = "scenario", folder: Path | None = None) -> Scenario:
    """Return the scenario in TOML `text`; `folder` is where its command file is looked for."""
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ScenarioError(f"scenario {name!r} is not valid TOML: {error}") from None
    _check_keys(raw, Tables, "", name)
    _check_finite(raw, "", name)
    try:
        tables = msgspec.convert(raw, Tables)
    except msgspec.ValidationError as error:
        raise ScenarioError(f"scenario {name!r}: {_readable(error)}") from None
    return _assemble(tables, name, folder or Path())


_TABLES: dict[str, type[msgspec.Struct]] = {
    "robot": RobotTable,
    "workspace": WorkspaceTable,
    "command": CommandTable,
    "dither": Dither,
    "limits": Limits,
    "command.segments": Segment,
}


def _check_keys(table: dict[str, Any], struct: type[msgspec.Struct], where: str, name: str) -> None:
    """Raise for a key that the table does not have, naming those that it has."""
    for key, value in table.items():
        path = f"{where}.{key}" if where else key
        if key not in struct.__struct_fields__:
            place = f"in [{where}]" if where else "at the top"
            raise ScenarioError(f"scenario {name!r}: {UnknownNameError(f'key {place}', key, struct.__struct_fields__)}")
        inner = _TABLES.get(path)
        if inner is not None:
            for entry in value if isinstance(value, list) else [value]:
                if isinstance(entry, dict):
                    _check_keys(entry, inner, path, name)


def _check_finite(value: Any, where: str, name: str) -> None:
    """Raise for nan and inf, which TOML allows and a robot does not."""
    if isinstance(value, float) and not math.isfinite(value):
        raise ScenarioError(f"scenario {name!r}: {where} must be a finite number, got {value}")
    if isinstance(value, dict):
        for key, entry in value.items():
            _check_finite(entry, f"{where}.{key}" if where else key, name)
    elif isinstance(value, list):
        for entry in value:
            _check_finite(entry, where, name)


def _readable(error: msgspec.ValidationError) -> str:
    """Turn msgspec's `... - at `$.robot.l`` into a place first, then what is wrong."""
    text, _, place = str(error).partition(" - at `$.")
    if place.startswith("command.frame"):
        text += f" (valid: {', '.join(Frame)})"
    text = text.replace("Expected `object`", "Expected a table").replace(
        "Object missing required field `command`", "missing required table [command]"
    )
    return f"{place.rstrip('`')}: {text}" if place else text


def _assemble(tables: Tables, name: str, folder: Path) -> Scenario:
    command, robot = tables.command, tables.robot
    if not (command.dt > 0.0 and command.duration > 0.0):
        raise ScenarioError(
            f"scenario {name!r}: command.duration and command.dt must be > 0 s, "
            f"got {command.duration:g} and {command.dt:g}"
        )
    if any(max(abs(one.v_c), abs(one.w_c)) > FASTEST for one in command.segments or ()):
        raise ScenarioError(f"scenario {name!r}: command.segments: v_c and w_c must be within +-{FASTEST:g}")
    if command.duration > LONGEST_S or command.duration / command.dt > MOST_STEPS:
        raise ScenarioError(
            f"scenario {name!r}: more than {LONGEST_S:,.0f} s or {MOST_STEPS:,} steps (duration / dt): "
            "use less time or a greater dt"
        )
    if (command.segments is None) == (command.file is None):
        raise ScenarioError(f"scenario {name!r}: [command] needs either segments or file, one of the two")
    if command.file is not None:
        segments = read_commands(folder / command.file, name)
    else:
        segments = command.segments or ()
    if any(later.t <= earlier.t for earlier, later in pairwise(segments)):
        raise ScenarioError(f"scenario {name!r}: the times t of the commands must increase from row to row")

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
    model = given.placed(mount, workspace)
    check_workspace(model, workspace)
    start_l = given.start.l if robot.l is None else robot.l
    start_psi = given.start.psi if robot.psi is None else robot.psi
    check_reach(given, start_l)
    if abs(start_psi) > math.pi:
        raise ScenarioError(f"scenario {name!r}: robot.psi must be within +-pi rad, got {start_psi:g}")
    blend, parameters = read_law(tables.law, name)
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
