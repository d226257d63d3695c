"""Plug-ins of somebody else: a distribution that is installed for the length of a test."""

from __future__ import annotations

import os
from pathlib import Path

LAWS = """
import math, time
import msgspec
import overreach as ov

MOVING = 300  # calls with a command, before it goes bad

class Bad:
    frame, closes_residual = ov.Frame.HAND, True
    workspace, blend, mount = ov.Workspace(), ov.smoothstep(), ov.Mount()

    def __init__(self, name, bad):
        self.name, self._bad, self._law, self._moved = name, bad, ov.exact(), 0

    def split(self, l, psi, u_r, u_t):
        right = self._law.split(l, psi, u_r, u_t)
        self._moved += u_r != 0.0
        return self._bad(right) if self._moved > MOVING else right

def _raise(right):
    raise ZeroDivisionError("a plug-in's own")

def _hang(right):
    time.sleep(0.03)
    return right

def _leave(right):
    raise SystemExit(7)

def nan(): return Bad("nan", lambda right: msgspec.structs.replace(right, v_b=math.nan))
def raises(): return Bad("raises", _raise)
def hangs(): return Bad("hangs", _hang)
def nonsense(): return Bad("nonsense", lambda right: "forward!")
def leaves(): return Bad("leaves", _leave)
def mistyped(work_space=None, blend=None): return ov.exact(work_space, blend)
def greedy(robott): return ov.exact()
def partial(): return object()
def own(workspace=None, gain=2.0): return ov.exact(workspace)
"""
"""Laws that are right until they have moved the hand for a while, and makers of laws that cannot be had."""


def install(folder: Path, module: str = "bad_laws", text: str = LAWS, group: str = "overreach.laws") -> dict[str, str]:
    """Write a distribution of one module whose functions are entry points; return an environment that has it."""
    (folder / f"{module}.py").write_text(text)
    info = folder / f"{module}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {module}\nVersion: 1.0\n")
    makers = [line.split("(")[0].removeprefix("def ") for line in text.splitlines() if line.startswith("def ")]
    lines = [f"{maker} = {module}:{maker}" for maker in makers if not maker.startswith("_")]
    (info / "entry_points.txt").write_text(f"[{group}]\n" + "\n".join(lines) + "\n")
    return os.environ | {"PYTHONPATH": str(folder)}
