"""Whether the stamps of a command file fit the run: a run that would stand still in silence is an error instead."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum

from overreach.errors import ScenarioError
from overreach.types import Record


class TimeFrom(StrEnum):
    """What the stamps count from: the run's start, or their own first one."""

    ABSOLUTE = "absolute"
    RELATIVE = "relative"


class TimeUnit(StrEnum):
    """The unit of the stamps."""

    S = "s"
    MS = "ms"
    US = "us"
    NS = "ns"


SECONDS = {TimeUnit.S: 1.0, TimeUnit.MS: 1e-3, TimeUnit.US: 1e-6, TimeUnit.NS: 1e-9}
EPOCH = ((1e17, TimeUnit.NS), (1e14, TimeUnit.US), (1e11, TimeUnit.MS), (1e8, TimeUnit.S))
"""A stamp above this, in this unit, is a time since 1970: the year 1973 or later in each."""
LONG = 20.0
"""Stamps that go on for this many times the run were not meant in its unit."""
FEW = 3


class Segment(Record, frozen=True):
    """From t [s] on, until the next segment, the command is this.

    v_c [m/s], w_c [rad/s or m/s]: the two axes of a stick, in the command's frame; v_z [m/s], w_x, w_y, w_z [rad/s]:
    the rest of the twist, w_z on top of what the stick says; gripper: its opening, 0 to 1, None to leave it.
    """

    t: float
    v_c: float = 0.0
    w_c: float = 0.0
    v_z: float = 0.0
    w_x: float = 0.0
    w_y: float = 0.0
    w_z: float = 0.0
    gripper: float | None = None


def fitted(
    segments: Sequence[Segment], duration: float, what: str, of: TimeFrom | None, unit: TimeUnit
) -> tuple[Segment, ...]:
    """Return `segments` with their times in seconds from the run's start.

    of: what the stamps count from; None, which is absolute, also asks whether they look as if it were otherwise.
    Raises ScenarioError, which begins with `what`, for stamps that do not fit a run of `duration` [s].
    """
    if not segments:
        raise ScenarioError(f"{what} has no rows: at least one command is needed")
    first = segments[0].t if of is TimeFrom.RELATIVE else 0.0
    if of is None:
        _check(segments, duration, what, unit)
    seconds = SECONDS[unit]
    moved = tuple([Segment((one.t - first) * seconds, one.v_c, one.w_c) for one in segments])
    if of is not None and not any(one.t < duration for one in moved):
        raise ScenarioError(f"{what}: the first row, at {moved[0].t:g} s, is after the end of the run ({duration:g} s)")
    return moved


def _check(segments: Sequence[Segment], duration: float, what: str, unit: TimeUnit) -> None:
    first, last = segments[0].t, segments[-1].t
    seconds = SECONDS[unit]
    since_1970 = next((of for least, of in EPOCH if first >= least and unit in (TimeUnit.S, of)), None)
    span = f"{what}: its stamps go from {first:.10g} to {last:.10g}"
    run = f"the run from 0 to {duration:g} s"
    if since_1970 is not None:
        say = 'time = "relative"' + (f', time_unit = "{since_1970}"' if since_1970 is not TimeUnit.S else "")
        raise ScenarioError(f"{span}, which look like {_named(since_1970)} since 1970, and {run}: say {say}")
    if first * seconds >= duration:
        raise ScenarioError(
            f"{span} {unit}, and {run}: no command would be carried out. "
            'Say time = "relative" if they count from another moment, '
            'time_unit = "ms", "us" or "ns" if they are no seconds'
        )
    within = sum(0.0 <= one.t * seconds < duration for one in segments)
    if within == 0:
        raise ScenarioError(f'{span} {unit}, all before {run}: say time = "relative" if they count from another moment')
    if len(segments) >= FEW and (within == 1 or last * seconds > LONG * duration):
        raise ScenarioError(
            f"{span} {unit}, and {run}: {within} of {len(segments)} rows would be carried out. "
            f'Say time_unit = "ms", "us" or "ns", give a longer duration, or say time = "absolute" if it is meant so'
        )


def _named(unit: TimeUnit) -> str:
    return {
        TimeUnit.S: "seconds", TimeUnit.MS: "milliseconds", TimeUnit.US: "microseconds", TimeUnit.NS: "nanoseconds",
    }[unit]  # fmt: skip
