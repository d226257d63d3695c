"""Mutation testing of `overreach.gate`: every small change of it must fail a test. Run by `make mutate`.

Mutants are cosmic-ray's, but for those that nobody could see (annotations, `@final`, `==` for the `is` of enums and
None) and those that are others once more (operators that floats lack, identity of floats).
Each module is judged by its tests in tests/gate alone. A time-out is no kill. Survivors must stand in SURVIVORS.md,
each with its diff and why no behaviour differs; there are at most MOST of them.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from queue import SimpleQueue

from cosmic_ray.work_db import WorkDB, use_db
from cosmic_ray.work_item import TestOutcome, WorkerOutcome

ROOT = Path(__file__).parents[2]
LISTED = Path(__file__).with_name("SURVIVORS.md")
MOST = 10
WORKERS = 2
TIMEOUT_S = 90.0
JUDGES = {
    "limits": ("limits", "gate"),
    "feedback": ("feedback",),
    "gate": ("gate",),
    "guard": ("guard",),
    "asked": ("feedback",),
    "stop": ("latch",),
    "watchdog": ("watchdog",),
}
"""Module -> the tests that judge it. The longest first."""
CONFIG = '''
[cosmic-ray]
module-path = ["src/overreach/gate/{module}.py"]
timeout = {timeout}
excluded-modules = []
test-command = """\\
  {python} -m pytest -q -x -p _hypothesis_pytestplugin -p no:cacheprovider --hypothesis-profile=mutate {judges}"""

[cosmic-ray.distributor]
name = "local"

[cosmic-ray.filters.operators-filter]
exclude-operators = [
  "core/RemoveDecorator",
  "core/Replace(Binary|Unary)Operator.*(Bit|Shift|Invert|Mod|Pow|FloorDiv).*",
  "core/ReplaceComparisonOperator_(Is_Eq|IsNot_NotEq)",
  "core/ReplaceComparisonOperator_(Eq|NotEq|Lt|LtE|Gt|GtE)_(Is|IsNot)",
]
'''


@dataclass
class Found:
    """What became of the mutants of one module."""

    module: str
    killed: int = 0
    alive: list[str] = field(default_factory=list)
    seconds: float = 0.0


def call(command: list[str], folder: Path) -> None:
    """Run a command of cosmic-ray's in a copy of the tree; show what it said where it fails."""
    environment = os.environ | {
        "PYTHONPATH": str(folder / "src"),
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",  # half of what a test run takes to begin
    }
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(command)} failed:\n{done.stdout}{done.stderr}")


@contextmanager
def copies(many: int) -> Iterator[SimpleQueue[Path]]:
    """Yield copies of the tree to work in: mutants are written in place."""
    with tempfile.TemporaryDirectory(prefix="mutate-") as folder:
        ready: SimpleQueue[Path] = SimpleQueue()
        skip = shutil.ignore_patterns("__pycache__", ".*_cache", ".hypothesis")
        for k in range(many):
            copy = Path(folder) / str(k)
            for part in ("src", "tests"):
                shutil.copytree(ROOT / part, copy / part, ignore=skip)
            shutil.copy(ROOT / "pyproject.toml", copy)
            ready.put(copy)
        yield ready


def judge(module: str, ready: SimpleQueue[Path]) -> Found:
    """Try every mutant of one module."""
    folder = ready.get()
    begun = time.monotonic()
    judges = " ".join(f"tests/gate/test_{name}.py" for name in JUDGES[module])
    config, session = folder / f"{module}.toml", folder / f"{module}.sqlite"
    config.write_text(CONFIG.format(module=module, timeout=TIMEOUT_S, python=sys.executable, judges=judges))
    binaries = Path(sys.executable).parent
    call([str(binaries / "cosmic-ray"), "baseline", str(config)], folder)
    call([str(binaries / "cosmic-ray"), "init", str(config), str(session)], folder)
    call([str(binaries / "cr-filter-operators"), str(session), str(config)], folder)
    call([str(binaries / "cosmic-ray"), "exec", str(config), str(session)], folder)
    found = Found(module)
    with use_db(str(session), WorkDB.Mode.open) as db:
        for item, result in db.completed_work_items:
            if result.worker_outcome is WorkerOutcome.SKIPPED:
                continue
            if result.test_outcome is TestOutcome.KILLED and result.output != "timeout":
                found.killed += 1
                continue
            note = "" if result.test_outcome is TestOutcome.SURVIVED else f"  ({result.test_outcome}: {result.output})"
            mutation = item.mutations[0]
            lines = [
                line for line in (result.diff or "").splitlines() if line[:1] in "+-" and line[:3] not in ("+++", "---")
            ]
            found.alive.append(
                "\n".join([f"{module}.py:{mutation.start_pos[0]} {mutation.operator_name}{note}", *lines])
            )
    found.seconds = time.monotonic() - begun
    ready.put(folder)
    return found


def main() -> None:
    """Try all modules, report, and exit with 1 where a survivor is not listed or there are too many."""
    modules = sys.argv[1:] or list(JUDGES)
    with copies(WORKERS) as ready, ThreadPoolExecutor(WORKERS) as pool:
        all_found = []
        for found in pool.map(lambda module: judge(module, ready), modules):
            all_found.append(found)
            total = found.killed + len(found.alive)
            print(
                f"{found.module + '.py':<14}{found.killed:>5} of {total:>4} killed  {found.seconds:>6.0f} s", flush=True
            )
    alive = [mutant for found in all_found for mutant in found.alive]
    listed = LISTED.read_text() if LISTED.exists() else ""
    unknown = [mutant for mutant in alive if "\n".join(mutant.splitlines()[1:]) not in listed]
    for mutant in alive:
        print(f"\n{'NOT LISTED ' if mutant in unknown else ''}{mutant}")
    print(f"\n{len(alive)} alive, {len(unknown)} of them not in {LISTED.name}")
    sys.exit(1 if unknown or len(alive) > MOST else 0)


if __name__ == "__main__":
    main()
