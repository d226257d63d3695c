"""A robot from its model file alone."""

from __future__ import annotations

from pathlib import Path

import pytest

from overreach.errors import SetupError
from overreach.model.catalogue import load
from overreach.model.described import DescribedRobot
from tests.model.test_files import urdf, written


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


def test_a_model_file_is_a_robot(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A URDF with speeds is described by guesses, its home found and its workspace measured, once, each with a line."""
    path = str(written(tmp_path, urdf()))
    model = load(path)
    assert isinstance(model, DescribedRobot)
    assert model.workspace.l_max - model.workspace.l_min > 0.05
    said = capsys.readouterr().err
    assert said.count("looking for a home") == said.count("measuring the workspace") == 1
    load.cache_clear()
    assert load(path).workspace == model.workspace
    assert capsys.readouterr().err == ""


def test_without_speeds_it_is_refused(tmp_path: Path) -> None:
    """A joint without a speed is not guessed: the way to say it is told."""
    with pytest.raises(SetupError, match=r"no speeds for arm_1, .*overreach describe"):
        load(str(written(tmp_path, urdf(velocity="0"))))
