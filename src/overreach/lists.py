"""What there is to choose from, as lines to print."""

from __future__ import annotations

from collections.abc import Iterator

from overreach.law.frame import FRAMES
from overreach.parameters import Parameters, schema, summary
from overreach.plugs import BLENDS, MODELS, blend_plug, law_names, law_plug, names, summaries, usable
from overreach.robots.load import ROBOTS


def laws() -> Iterator[str]:
    """Yield the laws, the blends and the command frames."""
    yield from _plugs("laws (--law), with their parameters (--set NAME=VALUE)", usable(law_names(), law_plug))
    yield from _plugs("blends", usable(names(BLENDS), blend_plug))
    yield from _entries(
        "command frames", {name: (frame.__doc__ or "").splitlines()[0] for name, frame in FRAMES.items()}
    )


def robots() -> Iterator[str]:
    """Yield the robots."""
    yield from _entries("robots", summaries(MODELS, ROBOTS))


def _entries(title: str, entries: dict[str, str]) -> Iterator[str]:
    yield title
    for name, line in entries.items():
        yield f"  {name:<12}{line}"


def _plugs(title: str, plugs: dict[str, type[Parameters] | str]) -> Iterator[str]:
    yield title
    for name, plug in plugs.items():
        if isinstance(plug, str):
            yield f"  {name:<12}cannot be used: {plug}"
            continue
        yield f"  {name:<12}{summary(plug)}"
        for one in schema(plug):
            choices = f", one of {', '.join(one.choices)}" if one.choices else ""
            yield f"{'':<14}{f'{one.name} = {one.shown}':<28}{one.title}{choices}"
