"""Drive a whole mobile manipulator by its hand.

The arm moves while it can reach; where the command would leave its workspace, the base takes over.
The names below are the public ones; each is loaded when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from overreach.arm.mount import Mount
    from overreach.control.pilot import Pilot, replay
    from overreach.control.tick import Tick
    from overreach.errors import OverreachError, SetupError
    from overreach.gate.gate import Gate
    from overreach.gate.limits import Limits
    from overreach.law.blend import Blend, Smoothstep, Step, Tanh
    from overreach.law.body import WholeBody
    from overreach.law.laws import Exact, Law, Paper, Switch
    from overreach.law.side import Side
    from overreach.model.planar import PlanarRobot, planar
    from overreach.model.workspace import Workspace
    from overreach.requests import ArmRequest
    from overreach.robots.base import Robot
    from overreach.robots.kinematic import KinematicRobot
    from overreach.run.scenario import load_scenario
    from overreach.run.simulate import simulate
    from overreach.types import BaseTwist, Command, Frame, Pose, RobotState, Split, Twist
from overreach.verdicts import Verdict

__version__ = "0.1.0"

_HOMES = {
    "Pilot": "control.pilot",
    "replay": "control.pilot",
    "Tick": "control.tick",
    "OverreachError": "errors",
    "SetupError": "errors",
    "simulate": "run.simulate",
    "load_scenario": "run.scenario",
    "Gate": "gate.gate",
    "Limits": "gate.limits",
    "Blend": "law.blend",
    "Smoothstep": "law.blend",
    "Step": "law.blend",
    "Tanh": "law.blend",
    "WholeBody": "law.body",
    "Law": "law.laws",
    "Exact": "law.laws",
    "Paper": "law.laws",
    "Switch": "law.laws",
    "Side": "law.side",
    "Mount": "arm.mount",
    "Workspace": "model.workspace",
    "PlanarRobot": "model.planar",
    "planar": "model.planar",
    "ArmRequest": "requests",
    "Robot": "robots.base",
    "KinematicRobot": "robots.kinematic",
    "BaseTwist": "types",
    "Command": "types",
    "Pose": "types",
    "Twist": "types",
    "Frame": "types",
    "RobotState": "types",
    "Split": "types",
    "Verdict": "verdicts",
}

__all__ = [
    "ArmRequest",
    "BaseTwist",
    "Blend",
    "Command",
    "Exact",
    "Frame",
    "Gate",
    "KinematicRobot",
    "Law",
    "Limits",
    "Mount",
    "OverreachError",
    "Paper",
    "Pilot",
    "PlanarRobot",
    "Pose",
    "Robot",
    "RobotState",
    "SetupError",
    "Side",
    "Smoothstep",
    "Split",
    "Step",
    "Switch",
    "Tanh",
    "Tick",
    "Twist",
    "Verdict",
    "WholeBody",
    "Workspace",
    "__version__",
    "load_scenario",
    "planar",
    "replay",
    "simulate",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'overreach' has no attribute {name!r}")
    return getattr(import_module(f"overreach.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
