"""One truth about a robot: its model. A law cannot differ from it, and there is one robot called `planar`."""

from __future__ import annotations

import msgspec
import pytest

from overreach.arm.mount import Mount
from overreach.law.laws import Exact
from overreach.model.planar import load_planar, planar
from overreach.plugs import load_model
from overreach.robots.kinematic import KinematicRobot
from overreach.run.scenario import load_scenario, parse_scenario
from overreach.run.simulate import simulate


def test_there_is_one_robot_called_planar() -> None:
    """By its name, from its file, as the default of the simulation and of a scenario: the same in every number."""
    assert load_planar() == planar() == load_model("planar") == KinematicRobot().model
    assert parse_scenario("[command]\nduration = 1.0\nsegments = []").model == planar()


@pytest.mark.parametrize("mount", [Mount(0.2, 0.1, 0.3), Mount(-0.1, 0.05, -0.2)])
def test_a_law_made_by_hand_is_the_law_by_name(mount: Mount) -> None:
    """With an offset shoulder `exact`, however it is made, is exact: the law asks the model for it."""
    scenario = load_scenario("aside")
    model = scenario.model.placed(mount, scenario.model.workspace)
    scenario = msgspec.structs.replace(scenario, model=model, duration=6.0, dt=0.002)
    by_name, by_hand = simulate(scenario, "exact"), simulate(scenario, Exact(scenario.blend))
    assert by_hand.summary.ee_error_max < 1e-9
    assert by_hand.rows == by_name.rows
    assert by_hand.rows[-1].v_b > 0.2
