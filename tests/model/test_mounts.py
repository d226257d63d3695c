"""Where an arm stands on its base: what is taken as it is, what is warned of, and what is refused."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from overreach.check.check import check
from overreach.errors import SetupError, WorkspaceError
from overreach.model.catalogue import measured, parts_for
from overreach.model.description import read_description
from overreach.model.measure.measure import Result
from tests.ur5 import HOME, written

AHEAD = 0.25


def result_of(path: str) -> Result:
    return measured(parts_for(path, "follow"))


def facing(yaw: float) -> tuple[float, ...]:
    """Return the home posture, turned about the shoulder."""
    return (yaw, *HOME[1:])


@pytest.mark.parametrize("s_x", [AHEAD, 0.0, -0.3], ids=["ahead", "over", "behind"])
def test_a_shoulder_ahead_of_over_and_behind_the_axle(s_x: float, tmp_path: Path) -> None:
    """An arm of UR5 size works wherever its shoulder is, and a reach inside leaves the base alone."""
    path = written(tmp_path, s_x)
    result = result_of(path)
    found = result.measured
    assert found.held == ("pitch", "spin", "third")
    assert found.p_x >= 0.15
    assert found.psi[0] <= -0.5
    assert found.psi[1] >= 0.5
    assert result.warnings == []
    streams = check(path, 6, 1, jobs=1)
    assert streams.ok_share == 1.0
    assert streams.ee_error_max < 1e-3
    assert (streams.joint_limit_violations, streams.self_contacts, streams.lateral_base_max) == (0, 0, 0.0)
    assert streams.reach_base_path == 0.0


def test_the_farther_behind_the_slower(tmp_path: Path) -> None:
    """p_x bounds full deflection: it shrinks as the shoulder goes back, until there is no room about straight ahead."""
    speeds = []
    for s_x in (AHEAD, 0.0, -0.3):
        folder = tmp_path / f"{s_x}"
        folder.mkdir()
        speeds.append(result_of(written(folder, s_x)).fastest)
    assert speeds == sorted(speeds, reverse=True)
    with pytest.raises(WorkspaceError, match=r"too narrow about straight ahead|beside the base"):
        result_of(written(tmp_path, -0.75))


def test_an_arm_at_the_back_turns_the_base_s_frame(tmp_path: Path) -> None:
    """Bolted behind and backwards it is refused, and told how; with the heading turned it is the one in front."""
    back, front = tmp_path / "back", tmp_path / "front"
    back.mkdir()
    front.mkdir()
    with pytest.raises(WorkspaceError, match=r"\[base\] heading = 3.14159"):
        result_of(written(back, -AHEAD, bolted=math.pi))
    turned = written(back, -AHEAD, bolted=math.pi, heading=math.pi)
    one, other = result_of(turned).measured, result_of(written(front, AHEAD)).measured
    assert (one.l, one.psi, one.z, one.sigma, one.p_x) == (other.l, other.psi, other.z, other.sigma, other.p_x)
    parts = parts_for(turned)
    assert parts.mount.s_x == pytest.approx(AHEAD)
    assert {round(wheel.y, 3) for wheel in parts.base.wheels} == {0.27, -0.27}
    assert check(turned, 3, 1, jobs=1).ok_share == 1.0


@pytest.mark.parametrize("yaw", [0.5, -0.7])
def test_a_sector_a_little_aside_is_taken_as_it_is(yaw: float, tmp_path: Path) -> None:
    """Up to 45 degrees off the way that the base drives: no warning, and streams are followed."""
    path = written(tmp_path, AHEAD, yaw=yaw, home=facing(yaw))
    result = result_of(path)
    assert result.warnings == []
    assert check(path, 4, 2, jobs=1).ok_share > 0.999


def test_a_sector_far_aside_is_warned_of_and_farther_refused(tmp_path: Path) -> None:
    """From 45 to 90 degrees a differential base is slow, and it is said; beyond it is refused; omni takes all."""
    result = result_of(written(tmp_path, AHEAD, yaw=0.85, home=facing(0.85)))
    assert any("49 degrees off" in line and "slow" in line for line in result.warnings)
    with pytest.raises(WorkspaceError, match="115 degrees off the way that the base drives"):
        result_of(written(tmp_path, AHEAD, yaw=2.0, home=facing(2.0)))
    path = written(tmp_path, AHEAD, yaw=2.0, home=facing(2.0), omni=True)
    assert result_of(path).warnings == []
    assert check(path, 4, 2, jobs=1).ok_share == 1.0


def test_a_heading_is_at_most_half_a_turn(tmp_path: Path) -> None:
    """One in degrees is refused in one line."""
    text = Path(written(tmp_path, AHEAD, heading=180.0)).read_text()
    with pytest.raises(SetupError, match=r"base\.heading must be -pi to pi rad, got 180"):
        read_description(text)
