from __future__ import annotations

import math
from typing import Any

import pytest

from overreach.law.blend import Step
from overreach.law.laws import Exact, Paper
from overreach.model.planar import load_planar, planar
from overreach.run import metrics
from overreach.run.row import Row
from overreach.run.scenario import load_scenario, parse_scenario
from overreach.run.simulate import simulate
from overreach.run.summary import LINES, table
from overreach.types import Frame, Split
from tests.laws import Given, exact
from tests.strategies import WORKSPACE

STILL = Row._make([*[0.0] * (len(Row._fields) - 1), (0.0, 0.0)])


def rows(**columns: list[Any]) -> list[Row]:
    """Return rows that are zero but for the columns given."""
    return [STILL._replace(**dict(zip(columns, values, strict=True))) for values in zip(*columns.values(), strict=True)]


def test_velocity_errors_are_rms_and_max() -> None:
    """sqrt(mean |e|^2) and max |e| of vectors of known length."""
    errors = [(3.0, 4.0), (0.0, 0.0)]
    assert metrics.ee_error_rms(errors) == pytest.approx(math.sqrt(12.5))
    assert metrics.ee_error_max(errors) == 5.0


def test_path_error_turns_with_the_robot() -> None:
    """A constant radial error on a hand that goes round once cancels out: it is at most a diameter off, not an arc."""
    n, dt = 1000, 0.01
    turning = rows(theta_b=[2.0 * math.pi * k / n for k in range(n)])
    radius = 0.1 * n * dt / (2.0 * math.pi)
    off = metrics.ee_path_error(turning, [(0.1, 0.0)] * n, 0.0, dt)
    assert off == pytest.approx(2.0 * radius, rel=1e-2)
    straight = metrics.ee_path_error(rows(psi=[0.3] * n), [(0.1, 0.0)] * n, 0.2, dt)
    assert straight == pytest.approx(0.1 * n * dt)


def test_travel_peak_and_variation_of_known_rates() -> None:
    """Path, rotation, peaks, slopes and total variation of a rate that goes up, down and back."""
    rate = [0.0, 0.2, -0.1, -0.1]
    assert metrics.travel(rate, 0.5) == pytest.approx(0.2)
    assert metrics.peak(rate) == 0.2
    assert metrics.slopes(rate, 0.1) == pytest.approx([2.0, -3.0, 0.0])
    assert metrics.total_variation(rate) == pytest.approx(0.5)
    assert metrics.peak([]) == 0.0


def test_an_authority_change_is_a_change_of_hands() -> None:
    """From below 1/4 to above 3/4 counts once, hovering in between not at all, and nothing without a command."""
    shares = [0.0, 0.5, 0.7, 0.3, 0.8, 0.5, 0.3, 0.9, 0.1, 0.1]
    going = rows(mu=shares, v_c=[0.1] * 10)
    assert metrics.authority_changes(going) == 2
    assert metrics.authority_changes(rows(mu=shares, v_c=[0.0] * 10)) == 0
    assert metrics.authority_changes(rows(sigma=shares, w_c=[-0.1] * 10)) == 2
    assert metrics.authority_changes(rows(mu=[0.4, 0.6] * 5, v_c=[0.1] * 10)) == 0


def test_beyond_is_measured_from_the_nearer_limit() -> None:
    """Outside in l and psi by how far, on either side; 0 inside."""
    l, psi = metrics.beyond(rows(l=[0.5, 0.4, 0.9], psi=[0.0, -0.7, 0.65]), WORKSPACE)
    assert l == pytest.approx([0.0, 0.05, 0.05])
    assert psi == pytest.approx([0.0, 0.1, 0.05])


def test_manipulability_is_the_determinant_of_the_jacobian() -> None:
    """a b |sin theta_2|: greatest with the elbow square, 0 straight."""
    model = load_planar("[arm]\nlinks = [0.5, 0.4]\n[workspace]\nl_max = 0.8")
    assert metrics.manipulability_min(rows(theta=[(0.3, math.pi / 2)]), model) == pytest.approx(0.2)
    assert metrics.manipulability_min(rows(theta=[(0.0, 1.0), (0.0, 0.0), (0.1, -1.0)]), model) == 0.0


def test_saturated_is_the_part_of_steps_at_a_limit() -> None:
    """A step counts once however many of its rates are at their limit, on either side."""
    assert metrics.saturated([(0.6, 0.0), (-0.6, 2.0), (0.5, 1.9), (0.0, -2.0)], (0.6, 2.0)) == 0.75


def test_joint_speeds_are_those_of_the_joints() -> None:
    """Peak joint speed and acceleration of a run are finite differences of its joint angles."""
    run = simulate("reach")
    dt = run.scenario.dt
    speeds = [(b.theta[1] - a.theta[1]) / dt for a, b in zip(run.rows, run.rows[1:], strict=False)]
    assert run.summary.peak_dtheta == pytest.approx(max(map(abs, speeds)), rel=1e-9)
    assert run.summary.peak_ddtheta > run.summary.peak_dtheta


def test_hard_switch_varies_more_than_a_blend() -> None:
    """Through a limit and back the hard switch changes the base's acceleration most: all at once."""
    scenario = load_scenario("outward")
    hard, soft = simulate(scenario, Exact(Step())), simulate(scenario, Exact())
    jump = max(metrics.slopes([row.v_b for row in hard.rows], scenario.dt))
    assert jump == pytest.approx(0.4 / scenario.dt)
    ramp = [row.v_b for row in soft.rows if row.t < 5.0]
    assert max(metrics.slopes(ramp, scenario.dt)) < 10.0


def test_the_table_shows_every_number_with_its_unit() -> None:
    """`overreach simulate` prints every field of the summary that is a measure."""
    summary = simulate("reach").summary
    shown = table(summary)
    told = {field for field, _, _ in LINES}
    words = {"scenario", "law", "frame", "blend", "steps", "duration", "verdicts"}
    assert told | words == set(summary.__struct_fields__)
    for _, label, unit in LINES:
        assert label.strip() in shown
        assert unit in shown


def test_cost_is_asked_on_the_states_of_the_run() -> None:
    """The law is timed on what it was given in the run: every picked state, its command in its frame."""
    run = simulate("aside", "exact")
    law = exact(blend=run.scenario.blend)
    seen = []

    def share(*case: float) -> Split:
        seen.append(case)
        return law.split(*case)

    cost = metrics.cost_per_step(Given(share), Frame.HAND, run.rows, planar())
    assert cost > 0.0
    assert 2_000 <= len(seen) <= 2_001
    first = run.rows[0]
    assert seen[0] == pytest.approx((first.l, first.psi, 0.4, 0.0), abs=1e-12)
    assert all(math.hypot(u_r, u_t) == pytest.approx(0.4) for _, _, u_r, u_t in seen)


@pytest.mark.parametrize(("l", "psi"), [(0.002, 0.0), (0.0, 0.005), (0.002, 0.005)])
def test_dither_swings_the_hand_by_what_it_says(l: float, psi: float) -> None:
    """Inside the workspace, where the arm does all, a tremor makes l and psi swing by exactly so much."""
    text = f"[command]\nduration = 2.0\nsegments = []\n[dither]\nl = {l}\npsi = {psi}\nf = 2.0\n"
    run = simulate(parse_scenario(text), Paper())
    for name, start, swing in (("l", 0.65, l), ("psi", 0.0, psi)):
        values = [getattr(row, name) - start for row in run.rows]
        assert max(values) == pytest.approx(swing, abs=0.01 * swing + 1e-12)
        assert min(values) == pytest.approx(-swing, abs=0.01 * swing + 1e-12)


def test_the_robot_is_asked_what_the_law_says_and_does_what_its_motors_can() -> None:
    """With slow motors what is asked for and what happens differ; without, they are the same."""
    slow, quick = simulate("dither", "switch"), simulate("outward", "paper")
    assert [v_b for v_b, _ in quick.asked] == [row.v_b for row in quick.rows]
    assert [v_b for v_b, _ in slow.asked] != [row.v_b for row in slow.rows]
    assert metrics.total_variation([v for v, _ in slow.asked]) > 3.0 * slow.summary.variation_v_b
