from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from tests.processes import gone, until

pytestmark = pytest.mark.real_time  # and a Ctrl-C of its own


@pytest.mark.parametrize(("how", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)], ids=["ctrl-c", "terminated"])
def test_reproduce_leaves_no_process_behind(tmp_path: Path, how: signal.Signals, code: int) -> None:
    """Ended in the middle, `reproduce` takes its workers with it, and leaves no half-written file."""
    out = tmp_path / "report"
    running = subprocess.Popen(
        [sys.executable, "-m", "overreach", "reproduce", "--out", str(out)], stderr=subprocess.PIPE, text=True
    )
    try:
        parent = psutil.Process(running.pid)
        until(lambda: len(parent.children(recursive=True)) >= 2, what="the workers")
        children = [child.pid for child in parent.children(recursive=True)]
        until(lambda: any((out / "data").glob("*.csv")) if out.exists() else False, what="the first data")
        os.kill(running.pid, how)
        assert running.wait(20) == code
        until(lambda: all(gone(child) for child in children), what="the end of the workers")
        assert running.stderr
        assert "Traceback" not in running.stderr.read()
    finally:
        running.kill()
        running.wait()
    assert not list(out.rglob("*.part"))
    assert not (out / "results.json").exists()
