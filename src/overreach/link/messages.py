"""Every message between the two halves, defined once. MessagePack on the wire; units as in `types`.

operator side                              robot side
    Command ---- overreach/NAME/command -->   latest wins
    Request ---- overreach/NAME/request -->   each answered: Accepted or Refused
    Stop ------- overreach/NAME/stop ----->   the same, on a connection of its own; newest wins
    Hello ------ overreach/NAME/hello ---->   answered: Welcome or Refused
            <--- overreach/NAME/state -----   State, latest wins
"""

from __future__ import annotations

import re

import msgspec

from overreach.arm.chain import Point
from overreach.errors import SetupError
from overreach.gate.limits import Limits
from overreach.model.base import Wheel
from overreach.model.workspace import Workspace
from overreach.parameters import Parameter
from overreach.requests import ArmRequest, DisarmRequest, ResetRequest, RestartRequest, StopRequest
from overreach.types import BaseTwist, Command, Frame, Pose, Record, Twist

PROTOCOL = 7
"""Raised when a message changes its meaning; both halves must use the same (a test checks that)."""

LONGEST = 4096
"""Longest message [bytes] that the robot side decodes."""

NAME = re.compile(r"[A-Za-z0-9_-]{1,40}")
"""What a robot may be called in a network."""
ANY = "*"


def key(robot: str, what: str) -> str:
    """Return the Zenoh key of `what` (command, request, stop, hello or state) for the robot called `robot`."""
    return f"overreach/{robot}/{what}"


def check_name(name: str) -> str:
    """Return a robot's name in the network; raises SetupError if it is not a valid one."""
    if not NAME.fullmatch(name):
        raise SetupError(f"a robot's name must be 1 to 40 of A-Z a-z 0-9 _ -, got {name!r}")
    return name


class Choice(Record, frozen=True):
    """A plug by its name, with the parameters that are set; the others keep their defaults."""

    name: str
    parameters: dict[str, float | str] = {}


class Settings(Record, frozen=True):
    """What an operator may change while the robot runs.

    law: a law or whole body; blend: for the laws that take one; frame: in which the pages command; workspace: where
    the arm works alone; speed_scale: the fraction of the limits that full stick asks for; hand: the one that is driven,
    of a robot that has several.
    """

    workspace: Workspace
    law: Choice = Choice("exact")
    blend: Choice = Choice("smoothstep")
    frame: Frame = Frame.WORLD
    speed_scale: float = 1.0
    hand: str = ""


class Plug(Record, frozen=True):
    """A law or blend to choose: its summary, its parameters, and whether it takes a blend."""

    summary: str
    parameters: tuple[Parameter, ...]
    blends: bool = False


class Scene(Record, frozen=True):
    """What is drawn around the base: closed lines through (x, y) [m] in the base frame.

    footprint: length and width of the base [m]; wheels: x, y [m], the way it rolls [rad] and radius [m] of each that
    drives it; workspace: where the arm works alone; bands: where base and arm blend.
    """

    footprint: tuple[float, float]
    wheels: tuple[Wheel, ...]
    workspace: tuple[tuple[float, float], ...]
    bands: tuple[tuple[tuple[float, float], ...], ...]


class ConfigureRequest(Record, frozen=True, tag="configure"):
    """Use these settings, all or none."""

    settings: Settings


AnyRequest = StopRequest | ResetRequest | ArmRequest | DisarmRequest | RestartRequest | ConfigureRequest


class Accepted(Record, frozen=True, tag="accepted"):
    """The request was carried out."""


class Refused(Record, frozen=True, tag="refused"):
    """The request was not carried out, and why, in a sentence for the operator."""

    reason: str


class Hello(Record, frozen=True):
    """The operator side's first message."""

    protocol: int
    version: str


class Welcome(Record, frozen=True, tag="welcome"):
    """The robot side's answer to a hello: what it is.

    name: in the network; model: which robot; rate [Hz]; limits: of the command, where a stick is at its end; reach: of
    the arm [m]; obeys: the parts of a twist, and "gripper", that it follows; hands: of a robot that has several, those;
    axes: by frame, what a two-axis stick, forward and leftward, commands; stop_time [s]: the longest time from a lost
    signal to standstill; laws, blends: what can be chosen, by name.
    """

    protocol: int
    version: str
    name: str
    model: str
    rate: float
    limits: Limits
    reach: tuple[float, float]
    obeys: tuple[str, ...]
    hands: tuple[str, ...]
    axes: dict[str, tuple[str, str]]
    stop_time: float
    max_delay: float
    simulated: bool
    laws: dict[str, Plug]
    blends: dict[str, Plug]
    settings: Settings
    defaults: Settings
    scene: Scene
    revision: int


Answer = Accepted | Refused | Welcome


class State(Record, frozen=True):
    """What the robot side tells, at least 50 times a second.

    t [s]: on the robot side's monotonic clock; tick: number of the period; operator: who has armed; ack, seen: seq
    of their last accepted command, and the `t` of the state that they had heard of when sending it; heard: seq of
    the newest that came from them, accepted or not; age [s]: how old that was when it came. verdict, word,
    sentence, look: as in `verdicts`; scale: the part of the command that is carried out; stopped: whether it is
    stopped or faulted, so that only a reset leads out. twist, in `frame`, and gripper: the command that the gate
    let through, opening: the gripper's own, 0 to 1; forward [rad]: where x of the frame in the settings points, as
    a heading in the world. l, psi, theta_e, mu, sigma, v_m, w_m and base: as in `types`; pose: of the base; joints
    [rad, m]; hand: its position in the world [m]; velocity: its true velocity in the world [m/s]; links: the arm as
    a line through points in the world [m]. State at t, rates from t on. Of the last second: late_p50, late_p99,
    late_max [us]: how late the loop's ticks began; apart_p99, apart_max [us]: by how much more than a period two
    writes were apart. revision: another number after every change of the settings and every start.
    """

    t: float
    tick: int
    operator: int
    ack: int
    seen: float | None
    heard: int
    age: float
    verdict: str
    word: str
    sentence: str
    look: str
    scale: float
    armed: bool
    stopped: bool
    twist: Twist
    frame: Frame
    forward: float
    gripper: float | None
    opening: float
    l: float
    psi: float
    theta_e: float
    mu: float
    sigma: float
    v_m: float
    w_m: float
    base: BaseTwist
    pose: Pose
    joints: tuple[float, ...]
    hand: Point
    velocity: Point
    links: tuple[Point, ...]
    late_p50: float
    late_p99: float
    late_max: float
    apart_p99: float
    apart_max: float
    overruns: int
    refused: int
    revision: int


encode = msgspec.msgpack.Encoder().encode
decode_command = msgspec.msgpack.Decoder(Command).decode
decode_request = msgspec.msgpack.Decoder(AnyRequest).decode
decode_stop = msgspec.msgpack.Decoder(StopRequest).decode
decode_hello = msgspec.msgpack.Decoder(Hello).decode
decode_answer = msgspec.msgpack.Decoder(Answer).decode
decode_state = msgspec.msgpack.Decoder(State).decode
