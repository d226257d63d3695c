"""Bytes of any kind in place of messages, for every decoder that something else can send to."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import msgspec
import pytest

from overreach.cockpit import wire
from overreach.host import records
from overreach.link import messages
from overreach.link.messages import Accepted, Choice, ConfigureRequest, Hello, Refused, Settings
from overreach.link.robot_end import NOT_UNDERSTOOD
from overreach.model.workspace import Workspace
from overreach.requests import ArmRequest, DisarmRequest, ResetRequest, RestartRequest, StopRequest
from overreach.robots.kinematic import KinematicRobot
from overreach.types import Command, Twist
from tests.reached import Reached

SETTINGS = Settings(Workspace(0.45, 0.85, -0.6, 0.6), Choice("qp", {"damping": 0.1}), Choice("step", {"damping": 0.1}))
COMMAND = Command(7, 1, 1, True, Twist(0.4, 0.1, 0.0, 0.0, 0.0, 0.2), gripper=0.5, seen=12.5)
REQUESTS = [
    StopRequest(),
    ResetRequest(),
    ArmRequest(7, 1),
    DisarmRequest(7),
    RestartRequest(),
    ConfigureRequest(SETTINGS),
]
STATE = KinematicRobot(now=3.0).read(3.0)
PAGE = [
    {"type": "command", "seq": 1, "grip": 1, "held": True, "twist": {"v_x": 0.4}, "frame": "world", "seen": 1.5},
    {"type": "beat", "seq": 4, "shown": 3, "seen": None},
    {"type": "shown", "n": 5},
    {"type": "ask", "id": 3, "what": "stop"},
]
msgpack = messages.encode
DECODERS: dict[str, tuple[Callable[[bytes], object], list[bytes]]] = {
    "command": (messages.decode_command, [msgpack(COMMAND)]),
    "request": (messages.decode_request, [msgpack(one) for one in REQUESTS]),
    "stop": (messages.decode_stop, [msgpack(StopRequest())]),
    "hello": (messages.decode_hello, [msgpack(Hello(4, "0.1.0"))]),
    "answer": (messages.decode_answer, [msgpack(Accepted()), msgpack(Refused("why"))]),
    "page": (wire.decode_from_page, [msgspec.json.encode(one) for one in PAGE]),
    "ask of the host": (records.decode_ask, [msgpack(records.Ask(1, 2.0, 3.0, (0.1, 0.2, 0.3, 0.4)))]),
    "report of the host": (records.decode_report, [msgpack(records.Report(1.0, STATE))]),
}


def mutated(rng: random.Random, message: bytes) -> bytes:
    """Return the message with bytes changed, left out, doubled or put in, or bytes of no message at all."""
    kind = rng.randrange(6)
    if kind == 0:
        return rng.randbytes(rng.randrange(64))
    out = bytearray(message)
    for _ in range(rng.randrange(1, 4)):
        at = rng.randrange(len(out) + 1)
        if kind == 1:
            del out[at:]
        elif kind == 2:
            out[at:at] = rng.randbytes(rng.randrange(1, 4))
        elif kind == 3:
            del out[at : at + rng.randrange(1, 4)]
        elif out and kind == 4:
            out[at - 1] ^= 1 << rng.randrange(8)
        elif out:
            out[at - 1] = rng.randrange(256)
    return bytes(out)


@pytest.mark.parametrize("name", DECODERS)
def test_fuzzed_messages(name: str, reached: Reached) -> None:
    """Whatever the bytes: a message, or one of the errors that are documented."""
    decode, samples = DECODERS[name]
    rng, many = random.Random(f"{reached.seed} {name}"), reached.times(1_000_000)
    refused = 0
    for _ in range(many):
        try:
            decode(mutated(rng, rng.choice(samples)))
        except NOT_UNDERSTOOD:
            refused += 1
    assert 0.2 * many < refused < many
    reached.say(
        "NaN, inf, wrong type, extra field", f"decoder of {name}: {many:,} fuzzed, {refused:,} refused, 0 other errors"
    )


def structs(value: Any) -> list[dict[str, Any]]:
    """Return every object within a decoded message, itself among them."""
    if isinstance(value, dict):
        return [value, *[one for part in value.values() for one in structs(part)]]
    if isinstance(value, list):
        return [one for part in value for one in structs(part)]
    return []


@pytest.mark.parametrize("name", [name for name in DECODERS if "host" not in name])
def test_no_message_takes_a_field_too_many(name: str) -> None:
    """Every object of every message refuses a field that it does not have; parameters of a law are free by design."""
    decode, samples = DECODERS[name]
    for sample in samples:
        json = name == "page"
        whole = msgspec.json.decode(sample) if json else msgspec.msgpack.decode(sample)
        encode = msgspec.json.encode if json else msgspec.msgpack.encode
        decode(encode(whole))
        for one in structs(whole):
            if "damping" in one:
                continue
            one["extra"] = 1
            with pytest.raises(msgspec.ValidationError, match="unknown field `extra`"):
                decode(encode(whole))
            del one["extra"]


def test_what_the_robot_side_tells_takes_no_field_too_many() -> None:
    """State and welcome, which the cockpit reads, are as strict: no part of them is of a looser kind."""
    kinds = [
        msgspec.inspect.type_info(kind) for kind in (messages.State, messages.Welcome, Command, messages.AnyRequest)
    ]
    seen: set[type] = set()

    def walk(info: Any) -> None:
        if isinstance(info, msgspec.inspect.StructType):
            if info.cls in seen:
                return
            seen.add(info.cls)
            assert info.forbid_unknown_fields, info.cls
            for field in info.fields:
                walk(field.type)
        for name in ("types", "item_types"):
            for part in getattr(info, name, ()):
                walk(part)
        for name in ("item_type", "value_type"):
            if hasattr(info, name):
                walk(getattr(info, name))

    for kind in kinds:
        walk(kind)
    assert len(seen) > 15
