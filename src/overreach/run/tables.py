"""The tables of a scenario file, with every key and number checked; what they amount to is `scenario`'s.

[robot]      name = "planar", l = 0.65, psi = 0.0, shoulder = [0.0, 0.0], mount_yaw = 0.0,
             delay_s, lag_s, noise, seed (of the actuators and encoders; all 0)
[workspace]  l_min, l_max, psi_min, psi_max
[law]        blend = "tanh"|"smoothstep"|"step", and its parameters: alpha, beta (tanh), q_l, q_psi (smoothstep)
[law.NAME]   parameters of the law NAME, where the scenario is run with it: [law.weighted] base_weight = 2.0
[command]    duration, dt, frame, and either segments = [{t, v_c, w_c}, ...] or file = "x.csv" (t,v_c,w_c);
             time = "relative" if the times count from the first of them, time_unit = "ms", "us" or "ns"
[dither]     l, psi, f: a tremor added to the command, as swings of the hand [m, rad] at f [Hz]
[limits]     v_c, w_c, dv_c, dw_c: without this table nothing is limited, to show the law alone
"""

from __future__ import annotations

import math
import tomllib
from typing import Any

import msgspec

from overreach.errors import ScenarioError, UnknownNameError
from overreach.gate.limits import Limits
from overreach.run.stamps import Segment, TimeFrom, TimeUnit
from overreach.types import Frame, Record


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
    """The table [command]. time, time_unit: of the rows' stamps; see `stamps`."""

    duration: float
    dt: float = 0.001
    frame: Frame | None = None
    segments: tuple[Segment, ...] | None = None
    file: str | None = None
    time: TimeFrom | None = None
    time_unit: TimeUnit = TimeUnit.S


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


def read_tables(text: str, name: str) -> Tables:
    """Return the tables in TOML `text`; raises ScenarioError, whose text is one line, for what is not valid."""
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ScenarioError(f"scenario {name!r} is not valid TOML: {error}") from None
    _check_keys(raw, Tables, "", name)
    _check_finite(raw, "", name)
    try:
        return msgspec.convert(raw, Tables)
    except msgspec.ValidationError as error:
        raise ScenarioError(f"scenario {name!r}: {_readable(error)}") from None


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
    for key, valid in {"command.frame": Frame, "command.time_unit": TimeUnit, "command.time`": TimeFrom}.items():
        if place.startswith(key):
            text += f" (valid: {', '.join(valid)})"
    text = text.replace("Expected `object`", "Expected a table").replace(
        "Object missing required field `command`", "missing required table [command]"
    )
    return f"{place.rstrip('`')}: {text}" if place else text
