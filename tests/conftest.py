"""What all tests share. Hypothesis draws the same cases every time: a test that fails, fails again."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, Phase, settings

from tests.reached import Reached

if TYPE_CHECKING:
    from playwright.sync_api import Browser

settings.register_profile("overreach", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow])
# For mutants any counterexample will do: it need not be the smallest.
settings.register_profile("mutate", settings.get_profile("overreach"), phases=[Phase.explicit, Phase.generate])
settings.load_profile("overreach")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Two options of `make faults`."""
    parser.addoption("--full", action="store_true", help="try every fault as often as is promised, and write it down")
    parser.addoption("--seed", type=int, default=1, help="of the random times at which faults come")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what `make faults` runs: every test that says what it reached."""
    for item in items:
        if "reached" in getattr(item, "fixturenames", ()):
            item.add_marker("fault")


@pytest.fixture
def reached(request: pytest.FixtureRequest) -> Reached:
    """How often to try, and where to say what was reached."""
    option = request.config.getoption
    return Reached(request.node.nodeid, option("--full"), option("--seed"))


@pytest.fixture(scope="session")
def menagerie() -> Path:
    """Where the models of real robots are: without them their tests are skipped, but not where it counts."""
    folder = os.environ.get("MENAGERIE_ROOT", "")
    if folder:
        return Path(folder)
    why = "MENAGERIE_ROOT is not set: no real robot's model is tested. Set it to a copy of the MuJoCo menagerie."
    if os.environ.get("CI") == "true":
        pytest.fail(why)
    pytest.skip(why)


@pytest.fixture(scope="session")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What one whole run of `reproduce` wrote, with the timing cut short: many tests look at it."""
    from overreach.reproduce import cost, run

    folder = tmp_path_factory.mktemp("reproduce") / "new" / "report"
    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)  # osqp's own
        patch.setattr(cost, "ROUNDS", 1)
        patch.setattr(cost, "SAMPLES", 30)
        run.reproduce(folder, progress=False)
    return folder


@pytest.fixture(scope="session")
def debugging_port() -> int:
    """The port at which the browser takes events faster than Playwright sends them."""
    from overreach.link.endpoint import free_port

    return free_port()


@pytest.fixture(scope="session")
def browser(debugging_port: int) -> Iterator[Browser]:
    """One Chromium for all tests; without it they are skipped, and in CI they fail."""
    from tests.browser.chromium import chromium
    from tests.browser.install import find

    path = find()
    if path is None:
        message = "no Chromium: run `make browser`"
        if os.environ.get("CI") == "true":
            pytest.fail(message)
        pytest.skip(message)
    with chromium(f"--remote-debugging-port={debugging_port}") as running:
        yield running
