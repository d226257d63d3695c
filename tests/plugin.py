"""Plug-ins of somebody else: a distribution that is installed for the length of a test."""

from __future__ import annotations

import os
import re
from pathlib import Path

LAWS = """
import math, time
from typing import Annotated
import msgspec
import overreach as ov
from overreach.parameters import number

MOVING = 300  # calls with a command, before it goes bad

class _Bad(ov.Law, frozen=True):
    name = "bad"

    def bind(self, model):
        law, moved = ov.Exact().bind(model), 0

        def share(l, psi, u_r, u_t):
            nonlocal moved
            moved += u_r != 0.0
            right = law(l, psi, u_r, u_t)
            return self.bad(right) if moved > MOVING else right

        return share

class Nan(_Bad, frozen=True):
    name = "nan"
    def bad(self, right): return msgspec.structs.replace(right, v_b=math.nan)

class Raises(_Bad, frozen=True):
    name = "raises"
    def bad(self, right): raise ZeroDivisionError("a plug-in's own")

class Hangs(_Bad, frozen=True):
    name = "hangs"
    def bad(self, right):
        time.sleep(0.03)
        return right

class Nonsense(_Bad, frozen=True):
    name = "nonsense"
    def bad(self, right): return "forward!"

class Leaves(_Bad, frozen=True):
    name = "leaves"
    def bad(self, right): raise SystemExit(7)

class Misnamed(_Bad, frozen=True):
    name = "another"

class Partial:
    name = "partial"

class Own(ov.Law, frozen=True):
    name = "own"
    gain: Annotated[float, number("gain", "1/s", 0.0, 10.0, above=0.0)] = 2.0
    shift: Annotated[float, number("shift", "m", -0.1, 0.1)] = 0.0

    def bind(self, model):
        share = ov.Exact().bind(model)
        return lambda l, psi, u_r, u_t: share(l + self.shift, psi, u_r, u_t)
"""
"""Laws that are right until they have moved the hand for a while, laws that cannot be had, and one with parameters."""


def install(folder: Path, module: str = "bad_laws", text: str = LAWS, group: str = "overreach.laws") -> dict[str, str]:
    """Write a distribution of one module, its public functions and classes entry points; return its environment."""
    (folder / f"{module}.py").write_text(text)
    info = folder / f"{module}-1.0.dist-info"
    info.mkdir(exist_ok=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {module}\nVersion: 1.0\n")
    makers = re.findall(r"^(?:def|class) ([A-Za-z]\w*)", text, re.MULTILINE)
    lines = [f"{maker.lower()} = {module}:{maker}" for maker in makers]
    (info / "entry_points.txt").write_text(f"[{group}]\n" + "\n".join(lines) + "\n")
    return os.environ | {"PYTHONPATH": str(folder)}
