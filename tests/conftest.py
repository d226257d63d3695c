"""What all tests share. Hypothesis draws the same cases every time: a test that fails, fails again."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from overreach.experiments.reproduce import cost, run

settings.register_profile("overreach", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("overreach")


@pytest.fixture(scope="session")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What one whole run of `reproduce` wrote, with the timing cut short: many tests look at it."""
    folder = tmp_path_factory.mktemp("reproduce") / "new" / "report"
    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)  # osqp's own
        patch.setattr(cost, "ROUNDS", 1)
        patch.setattr(cost, "SAMPLES", 30)
        run.reproduce(folder, progress=False)
    return folder
