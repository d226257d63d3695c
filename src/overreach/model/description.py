"""The description of a robot that has a model file: what the file does not say, or says wrongly. One TOML beside it.

name, summary     the name under which it is chosen, and one line about it
model             the model file: a path from the TOML, "menagerie:ROBOT/ENTRY", "package:MODULE/PATH" for one that a
                  Python package brings, or "builtin:NAME"
mode              how the hand is held if nothing else is asked for; "follow" by default
[base]            kind "differential" or "omni", body, wheels; v_max, w_max, dv_max, dw_max, lag; footprint
                  (length, width); heading: where it drives to, as a yaw of its body [rad], pi for one that drives
                  with the model's back first
[arm]             joints, each a name or several that move together; speed, acceleration of each; never_touch:
                  pairs of bodies that cannot meet, where their shapes in the model are fuller than they are
[hand]            body, offset in it [m], approach axis in it; gripper: its joints, if any
[locked]          joints of the model that stay where they are, with their places: NAME = value
[mount]           s_x, s_y: the shoulder, by default the first hinge's place; yaw: where the arm's x axis points; of
                  an arm that moves its hand along one line only: by default where that begins, and where it points
[command]         v, w, v_z, dv, dw, dv_z: full deflection of the stick, and its ramps
home              the joints where the posture rests; [homes]: other ones, for a mode each
[hands.NAME]      instead of [arm], [hand], [mount], [command], home, [homes], [workspace.MODE], one such set for each
                  of several hands: [hands.left.arm] and so on. One is driven; the others' joints stay at their homes
[workspace.MODE]  what `overreach workspace` measured, for "follow", "fixed", "level" or "free"
"""

from __future__ import annotations

import math
import tomllib
from typing import Any

import msgspec

from overreach.errors import SetupError, UnknownNameError
from overreach.types import Record

MODES = ("follow", "fixed", "level", "free")
"""How the hand is held: its yaw follows the bearing; is fixed in the world; is free, with the hand level; all free."""
KINDS = ("differential", "omni")
"""How a base moves: driving and turning; sideways as well."""
Pair = tuple[float, float]
Triple = tuple[float, float, float]


class BaseTable(Record, frozen=True):
    """The table [base]."""

    body: str
    v_max: float
    w_max: float
    dv_max: float
    dw_max: float
    footprint: Pair
    kind: str = "differential"
    lag: float = 0.0
    wheels: tuple[str, ...] = ()
    heading: float = 0.0


class ArmTable(Record, frozen=True):
    """The table [arm]: joints from the base out, a lift among them; speed [rad/s, m/s], acceleration [1/s^2].

    never_touch: pairs of bodies that cannot meet, whatever their shapes in the model.
    """

    joints: tuple[str | tuple[str, ...], ...]
    speed: tuple[float, ...]
    acceleration: tuple[float, ...]
    never_touch: tuple[tuple[str, str], ...] = ()

    @property
    def groups(self) -> tuple[tuple[str, ...], ...]:
        """Each joint as the joints of the model that move together."""
        return tuple((one,) if isinstance(one, str) else one for one in self.joints)


class HandTable(Record, frozen=True):
    """The table [hand]."""

    body: str
    offset: Triple = (0.0, 0.0, 0.0)
    approach: Triple = (0.0, 0.0, 1.0)
    gripper: tuple[str, ...] = ()


class MountTable(Record, frozen=True):
    """The table [mount]; what is left out is found in the model."""

    s_x: float | None = None
    s_y: float | None = None
    yaw: float | None = None


class CommandTable(Record, frozen=True):
    """The table [command]: v, v_z [m/s], w [rad/s] at full deflection; dv, dv_z [m/s^2], dw [rad/s^2]."""

    v: float
    w: float
    v_z: float
    dv: float
    dw: float
    dv_z: float


class Measured(Record, frozen=True):
    """The table [workspace.MODE]: outer edges of the sector in which every posture was tried.

    l [m], psi [rad], z [m]: from, to; held: the turnings that the hand holds, as words; yaw: greatest deviation of a
    fixed yaw from the bearing [rad]; sigma: the least singular value there [m/s]; p_x: the least distance [m] of the
    hand ahead of the base's turning centre; model: hash of the model that was measured.
    """

    l: Pair
    psi: Pair
    z: Pair
    held: tuple[str, ...]
    sigma: float
    p_x: float
    model: str
    yaw: float = 0.0


class Description(Record, frozen=True):
    """A robot, as its TOML says; see the module. hands, driven, others: of one with several, their
    names, which it is, and the joints that only the others have.
    """

    name: str
    model: str
    base: BaseTable
    arm: ArmTable
    hand: HandTable
    home: tuple[float, ...]
    summary: str = ""
    mode: str = "follow"
    mount: MountTable = MountTable()
    command: CommandTable | None = None
    locked: dict[str, float] = {}
    homes: dict[str, tuple[float, ...]] = {}
    workspace: dict[str, Measured] = {}
    hands: tuple[str, ...] = ()
    driven: str = ""
    others: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        joints = len(self.arm.joints)
        for what, values in (("arm.speed", self.arm.speed), ("arm.acceleration", self.arm.acceleration)):
            if len(values) != joints or not all(math.isfinite(value) and value > 0.0 for value in values):
                raise SetupError(f"{what} must be a number > 0 for each of the {joints} joints, got {list(values)}")
        for home in (self.home, *self.homes.values()):
            if len(home) != joints or not all(map(math.isfinite, home)):
                raise SetupError(f"home must be a number for each of the {joints} joints, got {list(home)}")
        if not -math.pi <= self.base.heading <= math.pi:
            raise SetupError(f"base.heading must be -pi to pi rad, got {self.base.heading:g}")
        if self.base.kind not in KINDS:
            raise UnknownNameError("base.kind", self.base.kind, KINDS)
        for mode in (self.mode, *self.workspace, *self.homes):
            check_mode(mode)

    def in_mode(self, mode: str) -> Description:
        """Return the description with the home that it has for a mode, and that mode as its own."""
        return msgspec.structs.replace(self, home=self.homes.get(mode, self.home), homes={}, mode=mode)


def _of_hand(tables: dict[str, Any], hands: Any, hand: str, what: str) -> dict[str, Any]:
    """Return the tables of a robot of which one hand is driven, the other hands' joints locked at their homes."""
    own = {"arm", "hand", "mount", "command", "home", "homes", "workspace", "mode"}
    if not (isinstance(hands, dict) and hands and all(isinstance(one, dict) for one in hands.values())):
        raise SetupError(f"{what}: hands must be tables, such as [hands.left.arm]")
    if both := sorted(own & set(tables)):
        raise SetupError(
            f"{what}: {', '.join(both)} belongs under each of its hands ({', '.join(hands)}), not beside them"
        )
    for name, one in hands.items():
        if not name.isidentifier():
            raise SetupError(f"{what}: a hand's name must be a word, got {name!r}")
        if other := sorted(set(one) - own):
            raise SetupError(f"{what}: hands.{name}: unknown key {other[0]!r}; a hand has {', '.join(sorted(own))}")
    if hand and hand not in hands:
        raise UnknownNameError("hand", hand, hands)
    driven = hand or next(iter(hands))
    mine = {joint for group in _groups(hands[driven]) for joint in group}
    locked = dict(tables.get("locked", {}))
    others: list[str] = []
    for name, one in hands.items():
        groups, home = _groups(one), one.get("home", [])
        if len(groups) != len(home):
            raise SetupError(f"{what}: hands.{name}: home must be a number for each of its {len(groups)} joints")
        for group, at in zip(groups, home, strict=True):
            others += [joint for joint in group if joint not in mine]
            locked.update({joint: at / len(group) for joint in group if joint not in mine and joint not in locked})
    return {**tables, **hands[driven], "locked": locked, "hands": list(hands), "driven": driven, "others": others}


def _groups(hand: dict[str, Any]) -> list[list[str]]:
    arm = hand.get("arm")
    joints = arm.get("joints", []) if isinstance(arm, dict) else []
    return [one if isinstance(one, list) else [one] for one in joints]


def check_mode(mode: str) -> None:
    """Raise UnknownNameError, with the valid ones, unless there is such a mode."""
    if mode not in MODES:
        raise UnknownNameError("orientation mode", mode, MODES)


def read_description(text: str, what: str = "robot description", hand: str = "") -> Description:
    """Return the description in TOML `text`; raises SetupError that says what is wrong, and where.

    hand: of a robot that has several, the one that is to be driven, by default the first.
    """
    try:
        tables: dict[str, Any] = tomllib.loads(text)
        hands = tables.pop("hands", None)
        if hands is not None:
            tables = _of_hand(tables, hands, hand, what)
        elif hand:
            raise SetupError(f"{what} has one hand: there is no {hand!r}")
        return msgspec.convert(tables, Description)
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise SetupError(f"{what}: {error}") from None
