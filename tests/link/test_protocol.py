"""What the messages are: a change of meaning raises the protocol, and the page reads only what is sent."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path
from typing import Any

import msgspec
import pytest

import overreach
from overreach.cockpit import wire
from overreach.link import messages
from overreach.link.messages import LONGEST, Answer, AnyRequest, Hello, Scene, Settings, State, Welcome
from overreach.model.workspace import Workspace
from overreach.types import BaseTwist, Command, Pose

STATIC = Path(overreach.__file__).parent / "cockpit" / "static"
FINGERPRINTS = {
    2: "6162737beaea6836",
    3: "df4c228980fe815f",
    4: "0ad8f1bee0b373b8",
    5: "60d5d345c4cab49f",
    6: "5d211e1676af9b8e",
    7: "18db4c5f6ecf4010",
}
"""Protocol -> what its messages are, docstrings included: what a field means stands there."""


def fingerprint() -> str:
    """Return a digest of every message between the halves: fields, types, and what is said of them."""
    _, parts = msgspec.json.schema_components([Command, AnyRequest, Hello, Answer, State])
    keys = [messages.key("NAME", what) for what in ("command", "request", "hello", "state")]
    return hashlib.sha256(json.dumps([parts, keys], sort_keys=True).encode()).hexdigest()[:16]


def test_a_change_of_meaning_raises_the_protocol() -> None:
    """Messages other than those of this protocol need another number, and their fingerprint here beside it."""
    assert max(FINGERPRINTS) == messages.PROTOCOL
    assert fingerprint() == FINGERPRINTS[messages.PROTOCOL], (
        "a message has changed: raise PROTOCOL where its meaning did, and note the fingerprint in FINGERPRINTS"
    )


def test_the_greatest_settings_fit_into_a_message() -> None:
    """Settings with every parameter that there is, and long names, are shorter than what the robot side looks at."""
    many: dict[str, float | str] = {f"a_parameter_of_a_law_{k}": 0.123456789012345 for k in range(30)}
    choice = messages.Choice("a-law-with-a-long-name" * 2, many)
    settings = Settings(Workspace(0.45, 0.85, -0.6, 0.6), choice, choice)
    assert len(messages.encode(messages.ConfigureRequest(settings))) < LONGEST


def javascript() -> str:
    return "\n".join(path.read_text("utf-8") for path in sorted(STATIC.rglob("*.js")))


READS: dict[str, tuple[str, type[Any], set[str]]] = {
    "state": (r"(?:\bs|\bstate|\bpage\.state|this\.state)\??\.(\w+)", State, set()),
    "pose": (r"\bpose\.(\w+)", Pose, set()),
    "base": (r"\bs\.base\.(\w+)", BaseTwist, set()),
    "robot": (r"(?<!\()\brobot\.(\w+)", Welcome, set()),
    "settings": (r"\bsettings\.(\w+)", Settings, set()),
    "scene": (r"this\.scene\.(\w+)", Scene, set()),
}
"""What JavaScript reads of each message: how it is written there, and what is sent."""


@pytest.mark.parametrize("what", READS)
def test_the_page_reads_only_what_is_sent(what: str) -> None:
    """Every name that the JavaScript reads from a message is a field of that message."""
    pattern, sent, own = READS[what]
    read = set(re.findall(pattern, javascript())) - own
    assert read, "the JavaScript is written otherwise than this test looks for"
    assert read <= set(sent.__struct_fields__)


def test_what_the_page_destructures_is_sent() -> None:
    """Names that are taken out of a message by destructuring are fields of it."""
    text = javascript()
    taken = {
        "pose": (r"const \{ ([\w, ]+) \} = this\.state\.pose", Pose),
        "state": (r"const \{ ([\w, ]+) \} = this\.state;", State),
        "limits": (r"const \{ ([\w, ]+) \} = robot\.limits", overreach.Limits),
    }
    for pattern, sent in taken.values():
        found = {name for names in re.findall(pattern, text) for name in names.split(", ")}
        assert found, pattern
        assert found <= set(sent.__struct_fields__)


def test_the_page_says_what_is_taken() -> None:
    """A command from the page has the fields of its message, no more and none that is needed fewer."""
    said = re.search(r'type: "command", ([\w, ]+) \}', javascript())
    numbered = re.search(r"\{ \.\.\.message, (\w+): this\.seq, (\w+): ", javascript())
    assert said
    assert numbered
    names = {*said.group(1).split(", "), *numbered.groups()}
    assert names <= set(wire.CommandFromPage.__struct_fields__)
    needed = {field.name for field in msgspec.structs.fields(wire.CommandFromPage) if field.required}
    assert needed <= names
    beat = re.search(r'type: "beat", (\w+): ', javascript())
    assert beat
    assert {*numbered.groups(), *beat.groups()} == set(wire.BeatFromPage.__struct_fields__)


def test_no_kinematics_in_the_page() -> None:
    """The page draws what the robot side sends: it knows no joint angle, link or mount of any robot."""
    for word in ("theta_1", "theta_2", "links[", "mount", "shoulder", "l_max +", "psi_max +", "handVelocity"):
        assert word not in javascript(), word
