"""Every property of the law for every robot: what `overreach check --all` finds and says."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from overreach.check import every
from overreach.check.every import all_of_them, run_all, table
from overreach.check.properties import Property, properties
from overreach.commands import check
from overreach.errors import SetupError
from overreach.model.catalogue import parts_for
from tests.ur5 import written


def test_each_robot_in_each_mode_that_ships() -> None:
    """All that are described, in every mode for which there is a workspace."""
    assert {
        "mobile7#follow",
        "mobile7#fixed",
        "mobile4#follow",
        "omni7#fixed",
        "omni5#follow",
        "stretch#fixed",
    } <= set(all_of_them())


@pytest.mark.parametrize("which", ["mobile4", "omni5"])
def test_small_robots_keep_all_of_them(which: str) -> None:
    """Streams, a straight line with the arm aside, a drive after which the arm is back, a circle."""
    own = properties(which, 3, 1, jobs=1)
    assert [one.name for one in own if not one.kept] == []
    assert len({one.name for one in own}) == len(own) == (16 if which == "mobile4" else 14)
    assert "NOT KEPT" not in table(own)


def test_the_command_says_and_writes_what_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A robot whose workspace is said to be greater than it is breaks some: told, written, exit code 1."""
    path = Path(written(tmp_path, 0.25))
    key = parts_for(str(path)).key
    path.write_text(
        f"{path.read_text()}\n[workspace.follow]\nl = [0.3, 0.99]\npsi = [-1.0, 1.0]\nz = [0.2, 1.2]\n"
        f'held = ["pitch", "spin", "third"]\nsigma = 0.1\np_x = 0.4\nmodel = "{key}"\n'
    )
    monkeypatch.setattr(every, "all_of_them", lambda: ["mobile4#follow", str(path), "menagerie-robot-that-is-not-here"])
    out = tmp_path / "all.json"
    with pytest.raises(SystemExit) as ended:
        check(all=True, streams=2, seed=1, json=out, jobs=1)
    assert ended.value.code == 1
    said = capsys.readouterr().out
    assert "NOT KEPT" in said
    assert "menagerie-robot-that-is-not-here was not checked" in said
    report = json.loads(out.read_text())
    assert {one["robot"] for one in report["properties"] if one["kept"]} == {"mobile4", "ur5"}
    assert {one["robot"] for one in report["properties"] if not one["kept"]} == {"ur5"}


def test_nothing_to_check_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """No robot, or both one and all, or none whose model can be had: one line each."""
    with pytest.raises(SetupError, match="check needs a robot"):
        check()
    with pytest.raises(SetupError, match="a robot or --all, not both"):
        check("mobile4", all=True)
    monkeypatch.setattr(every, "all_of_them", lambda: ["nobody"])
    with pytest.raises(SetupError, match="no robot's model can be had"):
        run_all(1, 0, None, 1)


def test_a_property_is_kept_up_to_its_limit() -> None:
    """At the limit it is kept; beyond it, or short of a least value, it is not."""
    assert Property("r", "m", "n", 1e-3, 1e-3).kept
    assert not Property("r", "m", "n", 1.1e-3, 1e-3).kept
    assert not Property("r", "m", "n", 0.9998, 0.9999, least=True).kept
