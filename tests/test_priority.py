"""Who goes ahead of whom, where the machine permits it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from overreach.priority import AUTOGROUP, EAGER

SAYS = """
from overreach.priority import AUTOGROUP, eager
def now():
    print(open(AUTOGROUP).read().split()[-1])
now()
with eager():
    now()
    with eager():
        now()
    now()
now()
"""


@pytest.mark.skipif(not Path(AUTOGROUP).exists() or os.geteuid() != 0, reason="no groups of threads here, or no right")
def test_a_group_goes_ahead_for_as_long_as_it_is_needed() -> None:
    """The group of the process gets the priority, and the one that was first puts it back as it was."""
    made = subprocess.run(
        [sys.executable, "-c", SAYS], capture_output=True, text=True, check=True, start_new_session=True
    )
    assert made.stdout.split() == ["0", str(EAGER), str(EAGER), str(EAGER), "0"]
