from __future__ import annotations

import ast
import importlib
import inspect
import pkgutil
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import overreach
from overreach.control.controller import HandController
from overreach.control.pilot import Pilot
from overreach.gate.guard import Guard
from overreach.link.messages import Settings
from overreach.robot_side.loop import Loop
from overreach.robot_side.process import run_robot

ROOT = Path(overreach.__file__).parent
ARROWS: dict[str, set[str]] = {
    "errors": set(),
    "compiled": set(),
    "files": {"errors"},
    "verdicts": set(),
    "clock": set(),
    "look": set(),
    "priority": set(),
    "types": {"verdicts"},
    "requests": {"types"},
    "extras": {"errors"},
    "parameters": {"errors", "types"},
    "gate": {"errors", "verdicts", "types"},
    "arm": {"errors", "verdicts", "compiled", "types"},
    "model": {"errors", "compiled", "files", "look", "types", "extras", "gate", "arm"},
    "law": {"errors", "verdicts", "types", "parameters", "arm", "model"},
    "fast": {"errors", "arm", "model", "law"},
    "baselines": {"errors", "extras", "types", "parameters", "arm", "model", "law"},
    "plugs": {"errors", "parameters", "arm", "model", "law"},
    "control": {"errors", "verdicts", "requests", "types", "gate", "arm", "model", "law"},
    "robots": {"errors", "types", "model", "plugs"},
    "host": {"errors", "clock", "priority", "types", "gate", "model", "robots"},
    "testing": {"verdicts", "clock", "types", "arm", "model", "law", "robots"},
    "link": {"errors", "requests", "clock", "types", "parameters", "gate", "arm", "model"},
    "robot_side": {
        "errors", "requests", "clock", "priority", "types", "parameters", "gate", "arm", "model", "law", "plugs",
        "control", "robots", "host", "link",
    },
    "cockpit": {"errors", "clock", "requests", "types", "parameters", "gate", "plugs", "robots", "link", "robot_side"},
    "check": {"errors", "verdicts", "files", "requests", "types", "gate", "arm", "model", "plugs", "control", "robots"},
    "run": {
        "errors", "files", "verdicts", "requests", "clock", "types", "parameters", "gate", "arm", "model", "law",
        "plugs", "control", "robots",
    },
    "bench": {
        "errors", "requests", "clock", "types", "extras", "arm", "model", "law", "fast", "baselines", "plugs",
        "control", "robots", "check", "run",
    },
    "reproduce": {
        "errors", "files", "look", "types", "extras", "parameters", "model", "law", "baselines", "plugs", "run",
        "bench",
    },
    "lists": {"parameters", "law", "plugs", "robots"},
    "doctor": {"extras"},
    "commands": {
        "files", "parameters", "model", "plugs", "link", "robot_side", "cockpit", "check", "run", "bench", "reproduce",
        "lists", "doctor",
    },
    "cli": {"errors", "commands"},
    "__main__": {"cli"},
    "__init__": {"errors", "verdicts", "requests", "types", "gate", "arm", "model", "law", "control", "robots", "run"},
}  # fmt: skip
"""Room -> the rooms that it may import from, all of which stand before it: every arrow goes one way."""

PUBLIC = {
    "__version__",
    "Workspace", "Mount", "Law", "WholeBody", "Exact", "Side", "Paper", "Switch", "Blend", "Tanh", "Smoothstep", "Step",
    "Split", "Twist", "BaseTwist", "Pose", "RobotState", "Frame", "Command", "ArmRequest", "Tick", "Verdict",
    "PlanarRobot", "planar", "Robot", "KinematicRobot", "Pilot", "replay", "Gate", "Limits",
    "load_scenario", "simulate", "OverreachError", "SetupError",
}  # fmt: skip


def test_public_names_are_exact() -> None:
    """The public names are these, no more and no less, and each can be had."""
    assert set(overreach.__all__) == PUBLIC
    assert set(dir(overreach)) == PUBLIC
    for name in PUBLIC:
        assert getattr(overreach, name) is not None
    with pytest.raises(AttributeError):
        _ = overreach.no_such_name


def test_typed_and_lazy_names_agree() -> None:
    """What type checkers see imported is what is loaded lazily, from the same places."""
    tree = ast.parse((ROOT / "__init__.py").read_text())
    typed = {
        alias.name: node.module.removeprefix("overreach.")
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("overreach.")
        for alias in node.names
    }
    assert typed == overreach._HOMES


def modules() -> list[str]:
    return [
        info.name for info in pkgutil.walk_packages([str(ROOT)], "overreach.") if not info.name.endswith("__main__")
    ]


def test_public_things_are_documented() -> None:
    """Every module, public class, function and method says what it is."""
    silent = []
    for name in modules():
        module = importlib.import_module(name)
        if not module.__doc__:
            silent.append(name)
        for key, thing in vars(module).items():
            if key.startswith("_") or getattr(thing, "__module__", None) != name:
                continue
            if (inspect.isclass(thing) or inspect.isfunction(thing)) and not thing.__doc__:
                silent.append(f"{name}.{key}")
    assert silent == []


def imports(path: Path) -> set[str]:
    """Return the modules that a file imports, in functions and for type checkers as well."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            found.add(node.module or "")
    return found


def test_arrows_go_one_way() -> None:
    """Each room imports only from rooms before it that it is known to need, in function bodies too; none is exempt."""
    rooms = {
        path.name.removesuffix(".py")
        for path in ROOT.iterdir()
        if path.suffix == ".py" or (path / "__init__.py").exists()
    }
    assert set(ARROWS) == rooms
    before: set[str] = set()
    for room, needs in ARROWS.items():
        assert needs <= before, f"{room} imports from a room that stands after it"
        before.add(room)
    used: dict[str, set[str]] = {room: set() for room in ARROWS}
    for path in ROOT.rglob("*.py"):
        room = path.relative_to(ROOT).parts[0].removesuffix(".py")
        for module in imports(path):
            if module.startswith("overreach."):
                used[room].add(module.split(".")[1])
    assert {room: others - {room} for room, others in used.items()} == ARROWS


TWO_LINKS = re.compile(r"Arm2R|Chain2R|\b2R\b|\belbow\b|theta_[12]\b|arm\.planar|model\.planar|bench\.planar|\.links\[")
"""How the arm of two links is known by, in Python or JavaScript."""
KNOW_IT = ("model/planar.py", "model/data/planar.toml", "arm/planar.py", "fast/", "bench/", "reproduce/", "__init__.py")


def test_two_links_are_known_to_few() -> None:
    """Only the planar model and arm, and what is compiled from them, timed, and compared with the paper, know 2R."""
    for path in [*ROOT.rglob("*.py"), *ROOT.rglob("*.js"), *ROOT.rglob("*.html"), *ROOT.rglob("*.toml")]:
        name = str(path.relative_to(ROOT))
        if not name.startswith(KNOW_IT):
            found = TWO_LINKS.search(path.read_text("utf-8"))
            assert found is None, f"{name} knows {found and found.group()}"


def test_of_the_package_itself_only_the_version_is_imported() -> None:
    """No room imports the public names by way of the package: it would load what it does not need."""
    for path in ROOT.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and node.module == "overreach":
                assert {alias.name for alias in node.names} == {"__version__"}, path


def test_the_law_is_plain_arithmetic() -> None:
    """The law imports nothing but math, typing and the project's records: it can be compiled as it stands."""
    plain = {"__future__", "math", "typing", "collections.abc"}
    for path in (ROOT / "law").glob("*.py"):
        others = {module for module in imports(path) if not module.startswith("overreach.")}
        assert others <= plain, path


def test_only_the_clock_reads_time() -> None:
    """No module but clock.py asks for the time."""
    readers = {str(path.relative_to(ROOT)) for path in ROOT.rglob("*.py") if {"time", "datetime"} & imports(path)}
    assert readers == {"clock.py"}


def test_files_are_small() -> None:
    """No file of the package is longer than 300 lines."""
    long = {path.name: n for path in ROOT.rglob("*.py") if (n := len(path.read_text().splitlines())) > 300}
    assert long == {}
    assert sys.version_info >= (3, 11)


def test_nothing_that_moves_a_robot_can_switch_the_bounds_off() -> None:
    """Gate, limits and guard have no switch; what shows the law without them is reached by `simulate` alone."""
    unbounded = ("LawAlone", "PilotAlone", "NoBounds")
    users = {
        str(path.relative_to(ROOT))
        for path in ROOT.rglob("*.py")
        if any(name in path.read_text() for name in unbounded)
    }
    assert users == {"run/law_alone.py", "run/simulate.py"}
    derived = [
        f"{path.relative_to(ROOT)}: {node.name}"
        for path in ROOT.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ClassDef)
        and any(
            isinstance(base, ast.Name) and base.id in ("HandController", "Pilot", "Guard", "Bounds")
            for base in node.bases
        )
    ]
    assert derived == [
        "run/law_alone.py: NoBounds", "run/law_alone.py: LawAlone", "run/law_alone.py: PilotAlone",
    ]  # fmt: skip
    things: dict[str, Callable[..., Any]] = {
        "controller": HandController,
        "decide": HandController.decide,
        "pilot": Pilot,
        "tick": Pilot.tick,
        "loop": Loop,
        "run": run_robot,
        "guard": Guard,
        "write": Guard.write,
    }
    given = {name: set(inspect.signature(thing).parameters) - {"self"} for name, thing in things.items()}
    assert given == {
        "controller": {"model", "law", "ramp_s"},
        "decide": {"state", "twist", "dt", "now", "motion", "frame"},
        "pilot": {"model", "law", "limits", "max_delay"},
        "tick": {"state", "command", "now", "dt"},
        "loop": {"robot", "link", "clock", "rate", "law", "max_delay"},
        "run": {"robot", "listen", "rate", "parent", "name", "law", "hosted", "max_delay"},
        "guard": {"channels", "ramp_s"},
        "write": {"wanted", "motion", "dt"},
    }
    assert set(Settings.__struct_fields__) == {"workspace", "law", "blend", "frame", "speed_scale", "hand"}
    source = (ROOT / "run" / "law_alone.py").read_text()
    assert "overreach.robots" not in source
