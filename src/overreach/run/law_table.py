"""The table [law] of a scenario: a blend with its parameters, and tables of parameters for laws."""

from __future__ import annotations

from typing import Any

from overreach.errors import ScenarioError, SetupError, UnknownNameError
from overreach.law.blend import Blend
from overreach.parameters import schema
from overreach.plugs import BLENDS, blend_plug, law_names, law_plug, names

USUAL_BLEND = "tanh"
"""The blend of a scenario that names none: the paper's."""


def read_law(table: dict[str, Any], name: str) -> tuple[Blend, dict[str, dict[str, Any]]]:
    """Return the blend, and the parameters of laws by their names; raises ScenarioError if one cannot be used."""
    flat = {key: value for key, value in table.items() if not isinstance(value, dict)}
    try:
        kind = flat.pop("blend", USUAL_BLEND)
        if not isinstance(kind, str):
            raise SetupError(f"Expected `str`, got `{type(kind).__name__}`")
        blend = _blend(kind, flat, name)
        laws = {law: parameters for law, parameters in table.items() if isinstance(parameters, dict)}
        for law, parameters in laws.items():
            if law not in law_names():
                raise UnknownNameError("key in [law]", law, ("blend", *flat, *law_names()))
            law_plug(law).made(parameters, "law")
    except ScenarioError:
        raise
    except SetupError as error:
        raise ScenarioError(f"scenario {name!r}: law: {error}") from None
    return blend, laws


def _blend(kind: str, given: dict[str, Any], name: str) -> Blend:
    """Return the blend of that kind; parameters of other blends may be given too, so that switching is easy."""
    chosen = blend_plug(kind)
    known = {one.name: one for other in names(BLENDS) for one in schema(blend_plug(other))}
    for key, value in given.items():
        if key not in known:
            raise ScenarioError(f"scenario {name!r}: {UnknownNameError('key in [law]', key, ['blend', *known])}")
        if not isinstance(value, float | int) or isinstance(value, bool):
            raise ScenarioError(f"scenario {name!r}: law.{key}: Expected `float`, got `{type(value).__name__}`")
        known[key].check(value)
    own = {one.name for one in schema(chosen)}
    return chosen.made({key: float(value) for key, value in given.items() if key in own}, "blend")
