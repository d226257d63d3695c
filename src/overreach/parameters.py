"""A plug is a name and parameters. TOML, command line, page, lists and reports all read one schema of them.

    class Mine(Law, frozen=True):
        name = "mine"
        gain: Annotated[float, number("gain of mine", "1/s", 0.0, 10.0)] = 2.0

A field without a description can be set only from Python.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any, ClassVar, Self, get_args, get_type_hints

import msgspec

from overreach.errors import SetupError, UnknownNameError
from overreach.types import Record

Value = float | str
"""What a parameter may be set to from outside."""
STEPS = 100
"""The number of steps of a slider whose step is not given."""


class Parameter(Record, frozen=True):
    """What is known of one parameter.

    title, unit: for people; default: its value if none is given; low, high, step: the range that is offered to
    people; least: what a valid value must be above (None if any finite number is valid); choices: valid texts, empty
    for a number.
    """

    name: str
    title: str
    unit: str
    default: Value
    low: float = 0.0
    high: float = 0.0
    step: float = 0.0
    least: float | None = None
    choices: tuple[str, ...] = ()

    @property
    def shown(self) -> str:
        """The default with its unit, for people."""
        return self.default if isinstance(self.default, str) else f"{self.default:g} {self.unit}".rstrip()

    def check(self, value: object) -> None:
        """Raise SetupError unless `value` can be used."""
        if self.choices:
            if value not in self.choices:
                raise UnknownNameError(self.title, str(value), self.choices)
            return
        if isinstance(value, int | float) and not isinstance(value, bool):
            if math.isfinite(value) and (self.least is None or value > self.least):
                return
            got = f"{value:g}"
        else:
            got = repr(value)
        bound = "" if self.least is None else f" > {self.least:g}"
        raise SetupError(f"{self.name} must be a finite number{bound}, got {got}")

    def read(self, text: Value) -> Value:
        """Return the value that command-line `text` stands for; raises SetupError if it stands for none."""
        if self.choices or not isinstance(text, str):
            return text
        try:
            return float(text)
        except ValueError:
            raise SetupError(f"{self.name} must be a number, got {text!r}") from None


def number(
    title: str, unit: str, low: float, high: float, step: float | None = None, above: float | None = None
) -> msgspec.Meta:
    """Describe a number: offered from `low` to `high` in steps of `step`; valid if finite and, if given, > `above`."""
    step = (high - low) / STEPS if step is None else step
    return msgspec.Meta(title=title, extra={"unit": unit, "low": low, "high": high, "step": step, "least": above})


def choice(title: str, choices: Sequence[str]) -> msgspec.Meta:
    """Describe a text that is one of `choices`."""
    return msgspec.Meta(title=title, extra={"unit": "", "choices": tuple(choices)})


class Parameters(Record, frozen=True):
    """Base of every plug: frozen parameters, each described by `number` or `choice`. Invalid ones raise SetupError."""

    name: ClassVar[str]
    """The name under which it is chosen."""

    def __post_init__(self) -> None:
        for parameter in schema(type(self)):
            parameter.check(getattr(self, parameter.name))

    @classmethod
    def made(cls, given: Mapping[str, Any], kind: str = "plug") -> Self:
        """Return a plug with the parameters `given`; raises SetupError for an unknown name or an invalid value.

        Numbers may be given as texts, as on a command line.
        """
        known = {one.name: one for one in schema(cls)}
        for key, value in given.items():
            own = key in cls.__struct_fields__ and not isinstance(value, str | int | float)  # a blend, a table
            if key not in known and not own:
                raise UnknownNameError(f"parameter of the {kind} {cls.name}", key, known)
        return cls(**{key: known[key].read(value) if key in known else value for key, value in given.items()})


@cache
def schema(plug: type[Parameters]) -> tuple[Parameter, ...]:
    """Return the described parameters of `plug`, in order; those without a description can be set only from Python."""
    found = []
    hints = get_type_hints(plug, include_extras=True)
    for field in msgspec.structs.fields(plug):
        for meta in get_args(hints[field.name])[1:]:
            if isinstance(meta, msgspec.Meta) and meta.extra and "unit" in meta.extra:
                found.append(_parameter(plug, field, meta))
    return tuple(found)


def _parameter(plug: type[Parameters], field: msgspec.structs.FieldInfo, meta: msgspec.Meta) -> Parameter:
    default = field.default
    if default is msgspec.NODEFAULT:
        raise SetupError(f"the parameter {field.name!r} of {plug.__name__} needs a default")
    extra: dict[str, Any] = meta.extra or {}
    default = default if isinstance(default, str) else float(default)
    return Parameter(field.name, meta.title or field.name, default=default, **extra)


def assignments(texts: Sequence[str]) -> dict[str, str]:
    """Return NAME=VALUE texts as a dictionary; raises SetupError for any other text."""
    for text in texts:
        if "=" not in text:
            raise SetupError(f"--set takes NAME=VALUE, got {text!r}")
    return dict(text.split("=", 1) for text in texts)


def summary(plug: type) -> str:
    """Return the first line of a plug's docstring."""
    lines = (plug.__doc__ or "").strip().splitlines()
    return lines[0] if lines else ""
