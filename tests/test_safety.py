"""What SAFETY.md says was reached is what a full run of the faults has written down."""

from __future__ import annotations

import json
import re

from tests.reached import FILE, NOT_YET, PAGE, ROWS, parts, table

NUMBER = re.compile(r"\d[\d,.]*")


def test_every_number_that_was_reached_is_in_the_file() -> None:
    """The table is the file's, to the letter: no number stands in it that the run has not written."""
    found = json.loads(FILE.read_text())
    _, shown, _ = parts(PAGE.read_text())
    assert shown == table(found)
    said = " ".join(text for texts in found["reached"].values() for text in texts)
    rows = [line.split("|") for line in shown.splitlines() if line.startswith("| ")][1:]
    assert len(rows) == len(ROWS)
    for _, fault, _, reached, _ in rows:
        for number in NUMBER.findall(reached):
            assert number in said, f"{fault.strip()}: {number}"


def test_every_promise_was_tried() -> None:
    """Each row of the table has been reached, or says that it is not there yet."""
    found = json.loads(FILE.read_text())
    assert found["commits"]
    assert all(re.fullmatch(r"[0-9a-f]{40}", one) for one in found["commits"])
    assert found["seeds"]
    for fault, (_, promise) in ROWS.items():
        assert bool(found["reached"][fault]) is (promise != NOT_YET), fault
