from __future__ import annotations

import json

import pytest

from overreach.bench import batch, measure, report, run, steps
from overreach.bench.machine import describe
from overreach.bench.measure import Candidate, Timed, in_turns, ratio, spread, statistics_of


def test_statistics_are_what_they_are_called() -> None:
    """Mean, min, quantiles by nearest rank and max of known numbers."""
    found = statistics_of([float(k) for k in range(1, 1001)])
    assert found == {"stamped_mean": 500.5, "min": 1.0, "p50": 500.0, "p99": 990.0, "p999": 999.0, "max": 1000.0}
    assert (spread([4.0]).low, spread([1.0, 2.0, 3.0]).median) == (4.0, 2.0)


def test_ratios_are_of_the_same_round() -> None:
    """A ratio compares what ran in the same round: a machine that slows down for a while changes nothing."""
    slow = Timed({0: {"mean": 10.0}, 1: {"mean": 40.0}, 2: {"mean": 20.0}}, 0)
    fast = Timed({0: {"mean": 1.0}, 1: {"mean": 4.0}}, 0)
    assert ratio(slow, fast, "mean").median == 10.0
    assert ratio(slow, fast, "mean").high == 10.0


def test_candidates_run_in_turns_with_every_argument() -> None:
    """Every candidate runs in each of its rounds, on all its arguments, in an order that turns."""
    heard: list[str] = []
    one = Candidate("one", lambda k: heard.append(f"one{k}"), [(0,), (1,)])
    two = Candidate("two", lambda k: heard.append(f"two{k}"), [(2,)], every=2)
    found = in_turns([one, two], 3)
    assert sorted(found["one"].rounds) == [0, 1, 2]
    assert sorted(found["two"].rounds) == [0, 2]
    assert found["one"].calls == 6
    # A round of a candidate is three passes: warm, mean, stamped. The second round begins with the second candidate.
    assert heard[:9] == ["one0", "one1"] * 3 + ["two2"] * 3
    assert heard[9:15] == ["one0", "one1"] * 3
    assert all(value > 0.0 for value in found["one"].as_dict()["spread"]["mean"])


@pytest.mark.filterwarnings("ignore:.*raise_error:PendingDeprecationWarning")
def test_the_report_says_what_was_measured_and_what_was_missed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A short run of the whole: JSON with what others read from it, text with every target, reached or missed."""
    monkeypatch.setattr(batch, "HEADLINE", 2_000)
    monkeypatch.setattr(batch, "SIZES", (100, 1_000))
    monkeypatch.setattr(run, "ROUNDS", 2)
    monkeypatch.setattr(steps, "SLOW_EVERY", 2)
    monkeypatch.setattr(run, "BATCH_TARGET", 1e15)
    stream = steps.stream
    monkeypatch.setattr(steps, "stream", lambda samples: stream(20))
    found = json.loads(json.dumps(run.measure(rounds=2, progress=False)))
    for kind in ("plain", "compiled"):
        assert {"mean", "p50", "p99", "max", "min"} <= found["step_us"][kind].keys()
    assert {"mean", "max", "min", "p999"} <= found["ratios"]["fastest_qp"].keys()
    assert found["ratios"]["default_qp"]["mean"] > 0.0
    assert found["batch"]["steps_per_s"] > 0.0
    assert set(found["batch"]["by_size"]) == {"100", "1000"}
    assert found["machine"]["python"] == describe()["python"]
    assert set(found["qp_parts_us"]) == {"model", "core", "allocation_and_call", "whole"}
    # What is neither model nor core is their difference from the whole: noise may bring it below 0.
    assert all(value > 0.0 for name, value in found["qp_parts_us"].items() if name != "allocation_and_call")
    text = report.text(found)
    missed = [one for one in found["targets"] if not one["reached"]]
    assert "batch, control steps per second" in {one["name"] for one in missed}
    lines = text.splitlines()
    for one in found["targets"]:
        assert set(one) == {"name", "target", "value", "reached"}  # the number and the target, and no excuse
        line = next(line for line in lines if one["name"] in line and line.startswith(("  reached", "  MISSED")))
        assert f"{one['value']:.4g}  of {one['target']:.4g}" in line
        assert line.endswith(f"{one['value'] / one['target']:.0%}")
        assert ("MISSED" in line) is not one["reached"]
    assert text.count("MISSED") == len(missed)


def test_the_stream_has_every_region() -> None:
    """The states that steps are timed on: arm alone, blending and base occur, and there is always a command."""
    rows = steps.stream(400)
    assert len(rows) == 400
    assert any(row.mu == 0.0 for row in rows)
    assert any(0.0 < row.mu < 1.0 for row in rows)
    assert any(0.0 < row.sigma < 1.0 for row in rows)
    assert all(row.v_c or row.w_c for row in rows)
    assert measure.clock_overhead(100) < 1e3
