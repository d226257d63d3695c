"""Plug-ins of somebody else that cannot be used say so at set-up, in one line."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from overreach.parameters import schema
from overreach.plugs import BLENDS, blend_plug, law_names, law_plug, names
from tests.plugin import install


def ask(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run a short scenario with a plug-in's law, as a user would."""
    command = [sys.executable, "-m", "overreach", "simulate", "outward", *arguments]
    return subprocess.run(command, env=install(folder), capture_output=True, text=True, check=False, timeout=60)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--law", "misnamed"), "the law 'misnamed' calls itself 'another': use one name"),
        (("--law", "partial"), "the law 'partial' is no subclass of overreach.law.laws.Law"),
        (("--law", "own", "--set", "gian=2"), "unknown parameter of the law own 'gian'. Did you mean 'gain'?"),
        (("--law", "own", "--set", "gain=fast"), "gain must be a number, got 'fast'"),
        (("--law", "own", "--set", "gain=-1"), "gain must be a finite number > 0, got -1"),
        (("--law", "own", "--set", "gain"), "--set takes NAME=VALUE, got 'gain'"),
        (("--law", "weighted", "--set", "base_weight=0"), "base_weight must be a finite number > 0, got 0"),
        (("--law", "qp", "--set", "solver=daqpp"), "unknown QP solver 'daqpp'. Did you mean 'daqp'?"),
    ],
)
def test_a_plug_that_cannot_be_used(arguments: tuple[str, ...], says: str, tmp_path: Path) -> None:
    """A law that is none, or a parameter that there is not, is one line and exit code 2."""
    done = ask(tmp_path, *arguments)
    assert done.returncode == 2
    assert says in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


def test_a_law_with_parameters_of_its_own(tmp_path: Path) -> None:
    """A law is one file and one entry point: its two parameters are set, listed and used, and no other line is."""
    plain = ask(tmp_path, "--law", "own", "--json")
    shifted = ask(tmp_path, "--law", "own", "--set", "shift=0.05", "gain=3", "--json")
    assert plain.returncode == shifted.returncode == 0, plain.stderr + shifted.stderr
    outside = [json.loads(done.stdout)["outside_l"] for done in (plain, shifted)]
    assert outside[1] == pytest.approx(outside[0] + 0.05, abs=1e-3)  # on the way in
    command = [sys.executable, "-m", "overreach", "laws"]
    listed = subprocess.run(command, env=install(tmp_path), capture_output=True, text=True, check=True)
    assert re.search(r"own .*\n +gain = 2 1/s +gain\n +shift = 0 m +shift", listed.stdout), listed.stdout


def test_every_parameter_is_described() -> None:
    """Each parameter of each law and blend that is offered has a title, and a default that is valid."""
    for plug in [*map(law_plug, law_names()), *map(blend_plug, names(BLENDS))]:
        for one in schema(plug):
            assert one.title
            one.check(one.default)
            assert one.choices or one.low < one.high
        assert set(plug().values) == {one.name for one in schema(plug)}  # it can be made as it is
