"""Drive a whole mobile manipulator by its hand.

The arm moves while it can reach; where the command would leave its workspace, the base takes over.
The names below are the public ones; each is loaded when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from overreach.control import HandController
    from overreach.errors import OverreachError, SetupError
    from overreach.gate.gate import Gate
    from overreach.gate.limits import Limits
    from overreach.law.blend import smoothstep, step, tanh
    from overreach.law.laws import Law, exact, paper, switch
    from overreach.law.workspace import Mount, Workspace
    from overreach.model.planar import PlanarRobot
    from overreach.robots.base import Robot
    from overreach.robots.kinematic import KinematicRobot
    from overreach.run.scenario import load_scenario
    from overreach.run.simulate import simulate
    from overreach.types import BaseTwist, Frame, RobotState, Split, Verdict

__version__ = "0.1.0"

_HOMES = {
    "HandController": "control",
    "OverreachError": "errors",
    "SetupError": "errors",
    "simulate": "run.simulate",
    "load_scenario": "run.scenario",
    "Gate": "gate.gate",
    "Limits": "gate.limits",
    "smoothstep": "law.blend",
    "step": "law.blend",
    "tanh": "law.blend",
    "Law": "law.laws",
    "exact": "law.laws",
    "paper": "law.laws",
    "switch": "law.laws",
    "Mount": "law.workspace",
    "Workspace": "law.workspace",
    "PlanarRobot": "model.planar",
    "Robot": "robots.base",
    "KinematicRobot": "robots.kinematic",
    "BaseTwist": "types",
    "Frame": "types",
    "RobotState": "types",
    "Split": "types",
    "Verdict": "types",
}

__all__ = [
    "BaseTwist",
    "Frame",
    "Gate",
    "HandController",
    "KinematicRobot",
    "Law",
    "Limits",
    "Mount",
    "OverreachError",
    "PlanarRobot",
    "Robot",
    "RobotState",
    "SetupError",
    "Split",
    "Verdict",
    "Workspace",
    "__version__",
    "exact",
    "load_scenario",
    "paper",
    "simulate",
    "smoothstep",
    "step",
    "switch",
    "tanh",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'overreach' has no attribute {name!r}")
    return getattr(import_module(f"overreach.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
