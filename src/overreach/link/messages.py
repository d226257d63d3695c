"""Every message between the two halves, defined once. MessagePack on the wire; units as in `types`.

operator side                         robot side
    Stick  ---- overreach/stick ------->   latest wins
    Request --- overreach/request ----->   each answered: Accepted or Refused
    Hello ----- overreach/hello ------->   answered: Welcome or Refused
          <---- overreach/state --------   State, latest wins
"""

from __future__ import annotations

import msgspec

from overreach.types import Frame, Stick

PROTOCOL = 1
"""Raised when a message changes its meaning; both halves must have the same."""

LONGEST = 4096
"""Longest message [bytes] that the robot side looks at."""

KEY_STICK = "overreach/stick"
KEY_REQUEST = "overreach/request"
KEY_HELLO = "overreach/hello"
KEY_STATE = "overreach/state"


class Settings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What an operator may change while the robot runs. L in m, Psi in rad, alpha in 1/m, beta in 1/rad."""

    law: str = "exact"
    blend: str = "smoothstep"
    frame: Frame = Frame.HAND
    alpha: float = 50.0
    beta: float = 50.0
    q_l: float = 0.1
    q_psi: float = 0.1
    l_min: float = 0.45
    l_max: float = 0.85
    psi_min: float = -0.6
    psi_max: float = 0.6
    speed_scale: float = 1.0


class Stop(msgspec.Struct, frozen=True, tag="stop"):
    """Latch the stop."""


class Reset(msgspec.Struct, frozen=True, tag="reset"):
    """Release the latch of the stop; moves nothing, arms nothing."""


class Arm(msgspec.Struct, frozen=True, tag="arm"):
    """Arm for this operator; its presses of the dead-man up to number `grip` do not count."""

    operator: int
    grip: int = 0


class Disarm(msgspec.Struct, frozen=True, tag="disarm"):
    """Disarm, if it is this operator who armed."""

    operator: int


class Restart(msgspec.Struct, frozen=True, tag="restart"):
    """Put a simulated robot back to its start; refused unless it is disarmed and at rest."""


class Configure(msgspec.Struct, frozen=True, tag="configure"):
    """Use these settings, all or none."""

    settings: Settings


Request = Stop | Reset | Arm | Disarm | Restart | Configure


class Accepted(msgspec.Struct, frozen=True, tag="accepted"):
    """The request was carried out."""


class Refused(msgspec.Struct, frozen=True, tag="refused"):
    """The request was not carried out, and why, in a sentence for the operator."""

    reason: str


class Hello(msgspec.Struct, frozen=True):
    """The operator side's first word."""

    protocol: int
    version: str


class Welcome(msgspec.Struct, frozen=True, tag="welcome"):
    """The robot side's answer: what it is. reach [m], links [m], footprint [m], rate [Hz]."""

    protocol: int
    version: str
    robot: str
    rate: float
    links: tuple[float, float]
    shoulder: tuple[float, float]
    mount_yaw: float
    footprint: tuple[float, float]
    v_max: float
    w_max: float
    stop_time: float
    simulated: bool
    settings: Settings
    defaults: Settings
    revision: int


Answer = Accepted | Refused | Welcome


class State(msgspec.Struct, frozen=True, gc=False):
    """What the robot side tells, at least 50 times a second.

    t [s] of the robot side's monotonic clock; tick: number of the period; ack: seq of the last accepted
    Stick of `operator`; verdict, word, sentence, look and scale: as in `types`; stopped: whether only a reset leads
    on; v_c, w_c: the command that got through the gate; the rest as in `types` (state at t, rates from t on).
    late_p50, late_p99, late_max [us]: the loop's lateness over the last second. revision: counts the changes of
    the settings.
    """

    t: float
    tick: int
    operator: int
    ack: int
    verdict: str
    word: str
    sentence: str
    scale: float
    armed: bool
    stopped: bool
    v_c: float
    w_c: float
    l: float
    psi: float
    theta_e: float
    mu: float
    sigma: float
    v_b: float
    w_b: float
    v_m: float
    w_m: float
    x_b: float
    y_b: float
    theta_b: float
    theta_1: float
    theta_2: float
    x_e: float
    y_e: float
    late_p50: float
    late_p99: float
    late_max: float
    overruns: int
    refused: int
    revision: int
    width_l: float
    width_psi: float
    look: str = "warn"


encode = msgspec.msgpack.Encoder().encode
decode_stick = msgspec.msgpack.Decoder(Stick).decode
decode_request = msgspec.msgpack.Decoder(Request).decode
decode_hello = msgspec.msgpack.Decoder(Hello).decode
decode_answer = msgspec.msgpack.Decoder(Answer).decode
decode_state = msgspec.msgpack.Decoder(State).decode
