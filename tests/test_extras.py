from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from overreach.errors import MissingExtraError, SetupError
from overreach.extras import pip_line, require

WITHOUT = """
import sys
for name in {missing!r}:
    sys.modules[name] = None
sys.argv = ["overreach", *{arguments!r}]
from overreach.cli import main
main()
"""


def without(missing: tuple[str, ...], *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run `overreach` as if some libraries were not installed."""
    code = WITHOUT.format(missing=missing, arguments=arguments)
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=60)


@pytest.mark.parametrize(
    ("missing", "arguments", "extra"),
    [
        (("qpsolvers",), ("simulate", "reach", "--law", "qp"), "qp"),
        (("qpsolvers",), ("simulate", "reach", "--law", "holistic"), "qp"),
        (("matplotlib",), ("reproduce", "--out", "OUT"), "figures,qp"),
        (("qpsolvers",), ("reproduce", "--out", "OUT"), "figures,qp"),
        (("numba",), ("bench",), "fast,qp"),
    ],
)
def test_a_missing_library_is_one_line_with_what_to_do(
    tmp_path: Path, missing: tuple[str, ...], arguments: tuple[str, ...], extra: str
) -> None:
    """What needs a library that is not installed says so in one line, with the pip line, and writes nothing."""
    done = without(missing, *(str(tmp_path / "out") if word == "OUT" else word for word in arguments))
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1
    assert "is not installed" in done.stderr
    assert pip_line(extra) in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ("simulate", "reach"),
        ("laws",),
        ("doctor",),
        ("simulate", "reach", "--law", "weighted"),
        ("simulate", "reach", "--robot", "mobile4"),
    ],
)
def test_driving_needs_no_extra(arguments: tuple[str, ...]) -> None:
    """Without numba, matplotlib, mink and every solver the rest works, and the laws are all named."""
    done = without(("numba", "matplotlib", "scipy", "qpsolvers", "daqp", "mink", "mujoco_menagerie"), *arguments)
    assert done.returncode == 0, done.stderr
    assert arguments != ("laws",) or "holistic" in done.stdout


def test_the_pip_line_is_how_this_copy_was_installed() -> None:
    """The line names the folder that this copy was installed from, so that it can be pasted."""
    line = pip_line("qp")
    assert line.startswith("pip install ")
    assert line.endswith("[qp]'")
    target = line.split("'")[1].removesuffix("[qp]")
    assert target == "overreach" or (Path(target) / "pyproject.toml").exists()


def test_a_library_that_is_there_but_broken_is_not_called_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only what is not installed is said to be missing; a library that fails on its own keeps its own error."""
    (tmp_path / "half_there.py").write_text("import surely_not_there\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(ModuleNotFoundError, match="surely_not_there"):
        require("half_there", "qp", "a test")
    with pytest.raises(MissingExtraError, match="surely_not_there is not installed"):
        require("surely_not_there", "qp", "a test")
    assert issubclass(MissingExtraError, SetupError)
