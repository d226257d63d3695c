"""Laws, whole bodies, blends, models and robots by name: entry points, each loaded only when it is asked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from overreach.arm.chain import is_aside
from overreach.errors import SetupError, UnknownNameError, told
from overreach.law.blend import Blend
from overreach.law.body import WholeBody
from overreach.law.laws import Law
from overreach.model.model import Model
from overreach.parameters import Parameters, schema, summary

LAWS = "overreach.laws"
"""Entry points to subclasses of `overreach.law.laws.Law`."""
BODIES = "overreach.bodies"
"""Entry points to subclasses of `overreach.law.body.WholeBody`: these plan all rates themselves. Chosen as laws are."""
BLENDS = "overreach.blends"
"""Entry points to subclasses of `overreach.law.blend.Blend`."""
MODELS = "overreach.models"
"""Entry points to functions that return a description: () -> Model."""

USUAL_MODEL = "planar"
"""The robot that is used if none is named."""

KINDS: dict[str, tuple[str, type[Parameters]]] = {
    LAWS: ("law", Law), BODIES: ("law", WholeBody), BLENDS: ("blend", Blend)
}  # fmt: skip
"""Group of entry points -> what people call its plugs, and the class that they extend."""


@cache
def _points(group: str) -> dict[str, EntryPoint]:
    """Read the installed packages' entry points, once: it takes milliseconds."""
    return {point.name: point for point in entry_points(group=group)}


def names(*groups: str) -> list[str]:
    """Return the names in entry-point groups, sorted."""
    return sorted({name for group in groups for name in _points(group)})


def point(group: str, name: str) -> EntryPoint:
    """Return an entry point by its name."""
    return _points(group)[name]


def law_names(model: Model | None = None) -> list[str]:
    """Return the names of all laws and whole bodies, or of those for such an arm as that of `model`: for --law."""
    found = names(LAWS, BODIES)
    if model is None:
        return found
    plugs = usable(found, law_plug)
    return [name for name in found if getattr(plugs[name], "aside", False) == is_aside(model.arm)]


def _plug(name: str, *groups: str) -> type[Any]:
    """Return the class of the plug called `name`; raises SetupError if there is none or it is not valid."""
    for group in groups:
        kind, wanted = KINDS[group]
        if name in _points(group):
            plug = _points(group)[name].load()
            if not (isinstance(plug, type) and issubclass(plug, wanted)):
                raise SetupError(f"the {kind} {name!r} is no subclass of {wanted.__module__}.{wanted.__name__}")
            if getattr(plug, "name", "") != name:
                raise SetupError(f"the {kind} {name!r} calls itself {getattr(plug, 'name', '')!r}: use one name")
            return plug
    raise UnknownNameError(KINDS[groups[0]][0], name, names(*groups))


def law_plug(name: str) -> type[WholeBody]:
    """Return the class of the law or whole body called `name`."""
    return _plug(name, LAWS, BODIES)


def blend_plug(name: str) -> type[Blend]:
    """Return the class of the blend called `name`."""
    return _plug(name, BLENDS)


def load_blend(name: str, parameters: Mapping[str, Any] | None = None) -> Blend:
    """Return the blend called `name`; raises SetupError for an unknown name or parameter."""
    return blend_plug(name).made(parameters or {}, "blend")


def usable(names_: Sequence[str], plug: Callable[[str], type[Parameters]]) -> dict[str, type[Parameters] | str]:
    """Return name -> the plug's class or, if it cannot be loaded, the reason."""
    found: dict[str, type[Parameters] | str] = {}
    for name in names_:
        try:
            made = plug(name)
            schema(made)  # described, too, or it cannot be offered
            found[name] = made
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # a plug-in may raise anything when it is imported, and leave, too
            found[name] = str(error) if isinstance(error, SetupError) else told(error)
    return found


def blends_in(plug: type[Parameters]) -> bool:
    """Say whether a law takes a blend."""
    return "blend" in plug.__struct_fields__


def load_law(name: str, parameters: Mapping[str, Any] | None = None, blend: Blend | None = None) -> WholeBody:
    """Return the law or whole body called `name`, with `blend` if it takes one.

    Raises UnknownNameError with the valid names, SetupError for a parameter that cannot be used, or MissingExtraError
    if it needs a library that is not installed.
    """
    plug = law_plug(name)
    given = dict(parameters or {})
    if blend is not None and blends_in(plug):
        given["blend"] = blend
    return plug.made(given, "law")


def model_names() -> list[str]:
    """Return the names of all robots that are described."""
    from overreach.model.catalogue import described

    return sorted({*names(MODELS), *described()})


def load_model(which: str) -> Model:
    """Return the robot called `which`, or in the file `which`, TOML or model; raises SetupError in one line.

    "#MODE" at its end says how its hand is held, where it can be held in several ways.
    """
    found = _points(MODELS)
    if which in found:
        maker: Callable[[], Model] = found[which].load()
        return maker()
    from overreach.model.catalogue import load

    check_model_name(which)
    return load(which)


def in_mode(which: str, mode: str, hand: str = "") -> str:
    """Return a robot, the one of its hands that is driven, and how that is held, where they are given, as one text."""
    from overreach.model.catalogue import HAND, IN_MODE

    which = f"{which}{HAND}{hand}" if hand else which
    return f"{which}{IN_MODE}{mode}" if mode else which


def check_model_name(which: str, others: Sequence[str] = ()) -> None:
    """Raise UnknownNameError, with the valid names, unless a robot is called so; a file is looked into.

    others: further names that are valid.
    """
    from overreach.model.catalogue import IN_MODE, description_of, handless, is_file
    from overreach.model.description import check_mode

    name, _, mode = which.partition(IN_MODE)
    if mode:
        check_mode(mode)
    if is_file(name):
        description_of(name)
        return
    known = sorted({*model_names(), *others})
    name, hand = handless(name)
    if name in model_names() and name not in names(MODELS):
        description_of(which.partition(IN_MODE)[0])  # it may not have such a hand
    elif hand:
        raise SetupError(f"the robot {name!r} has one hand: there is no {hand!r}")
    if name not in known:
        raise UnknownNameError("robot", name, known, "A file's name must end in .toml, .xml or .urdf.")
    if mode and name in {*names(MODELS), *others}:
        raise SetupError(f"the robot {name!r} has no orientation modes")


def summaries(*groups: str) -> dict[str, str]:
    """Return name -> the first line of what a plug says of itself, or why it cannot be had."""
    lines = {}
    if MODELS in groups:
        from overreach.model.catalogue import described
        from overreach.model.description import read_description

        lines = {name: read_description(text).summary for name, text in described().items()}
    for name, point in sorted((name, point) for group in groups for name, point in _points(group).items()):
        try:
            lines[name] = summary(point.load())
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # as above
            lines[name] = f"cannot be used: {told(error)}"
    return lines
