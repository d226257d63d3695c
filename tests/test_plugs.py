"""Plug-ins of somebody else that cannot be used say so at set-up, in one line."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.plugin import install


def ask(folder: Path, law: str) -> subprocess.CompletedProcess[str]:
    """Run a short scenario with a plug-in's law, as a user would."""
    command = [sys.executable, "-m", "overreach", "simulate", "outward", "--law", law]
    return subprocess.run(command, env=install(folder), capture_output=True, text=True, check=False, timeout=60)


@pytest.mark.parametrize(
    ("law", "says"),
    [
        ("mistyped", "has a parameter 'work_space', which nothing gives it. Did you mean 'workspace'?"),
        ("greedy", "has a parameter 'robott', which nothing gives it. Did you mean 'robot'?"),
        ("partial", "the law 'partial' lacks name, frame, closes_residual, workspace, blend, mount, split"),
    ],
)
def test_a_maker_that_cannot_be_used(law: str, says: str, tmp_path: Path) -> None:
    """A mistyped parameter of a law's maker, or a law that lacks something, is one line and exit code 2."""
    done = ask(tmp_path, law)
    assert done.returncode == 2
    assert says in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


def test_a_parameter_of_ones_own_is_fine(tmp_path: Path) -> None:
    """A maker may have parameters of its own, with defaults."""
    done = ask(tmp_path, "own")
    assert done.returncode == 0, done.stderr
    assert "EE velocity error" in done.stdout
