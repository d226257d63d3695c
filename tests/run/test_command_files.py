"""Command files as recorders, spreadsheets and shells write them."""

from __future__ import annotations

import codecs
from pathlib import Path

import pytest

from overreach.errors import ScenarioError
from overreach.run.scenario import load_scenario
from overreach.run.stamps import Segment

ROWS = "t,v_c,w_c\n0.0,0.1,0.0\n0.5,-0.2,0.3\n"
MEANT = (Segment(0.0, 0.1, 0.0), Segment(0.5, -0.2, 0.3))


def scenario(folder: Path, rows: str | bytes, more: str = "", duration: float = 3.0) -> tuple[Segment, ...]:
    """Return the commands of a scenario whose command file has `rows`."""
    (folder / "c.csv").write_bytes(rows if isinstance(rows, bytes) else rows.encode())
    (folder / "s.toml").write_text(f'[command]\nduration = {duration}\nfile = "c.csv"\n{more}\n')
    return load_scenario(folder / "s.toml").segments


def stamped(*stamps: float) -> str:
    return "t,v_c,w_c\n" + "".join(f"{t!r},0.2,0.0\n" for t in stamps)


MARKED = {
    "utf-8": codecs.BOM_UTF8,
    "utf-16-le": codecs.BOM_UTF16_LE,
    "utf-16-be": codecs.BOM_UTF16_BE,
    "utf-32-le": codecs.BOM_UTF32_LE,
    "utf-32-be": codecs.BOM_UTF32_BE,
}


@pytest.mark.parametrize("encoding", MARKED)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_byte_order_marks_are_read(tmp_path: Path, encoding: str, end: str) -> None:
    """A command file and a scenario that begin with a byte order mark are the same as without, in any encoding."""
    mark = MARKED[encoding]
    assert scenario(tmp_path, mark + ROWS.replace("\n", end).encode(encoding)) == MEANT
    text = f'[command]{end}duration = 3.0{end}file = "c.csv"{end}'
    (tmp_path / "marked.toml").write_bytes(mark + text.encode(encoding))
    assert load_scenario(tmp_path / "marked.toml").segments == MEANT


@pytest.mark.parametrize(
    ("stamps", "found"),
    [
        ((1764075000.0, 1764075001.5), 'seconds since 1970, and the run from 0 to 3 s: say time = "relative"'),
        ((1764075000e3, 1764075001.5e3), 'milliseconds since 1970, .*: say time = "relative", time_unit = "ms"'),
        ((1764075000e6, 1764075001.5e6), 'microseconds since 1970, .*: say time = "relative", time_unit = "us"'),
        ((1764075000e9, 1764075001.5e9), 'nanoseconds since 1970, .*: say time = "relative", time_unit = "ns"'),
        ((3.0,), "go from 3 to 3 s, .*no command would be carried out"),
        ((815.25, 816.75), "go from 815.25 to 816.75 s, .*no command would be carried out"),
        ((-8.0, -7.0), "all before the run"),
        ((0.0, 20.0, 40.0, 60.0), "1 of 4 rows would be carried out"),
        (tuple(float(k) for k in range(0, 1500, 20)), 'Say time_unit = "ms"'),
        (tuple(float(k) * 1e-9 + 20e6 * k for k in range(60)), 'Say time_unit = "ms", "us" or "ns"'),
        ((), "no rows"),
    ],
)
def test_stamps_that_do_not_fit_the_run_are_an_error(tmp_path: Path, stamps: tuple[float, ...], found: str) -> None:
    """A file with which the robot would stand still, or nearly, is refused, with what was found and what to say."""
    with pytest.raises(ScenarioError, match=found) as refused:
        scenario(tmp_path, stamped(*stamps))
    assert "\n" not in str(refused.value)
    assert "c.csv" in str(refused.value)


@pytest.mark.parametrize("unit", ["s", "ms", "us", "ns"])
@pytest.mark.parametrize("start", [0.0, -4.0, 815.25, 1764075000.0])
def test_relative_stamps_in_any_unit(tmp_path: Path, unit: str, start: float) -> None:
    """With `time = "relative"` and the unit, the first stamp is the run's start: what is refused above can be run."""
    per_second = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}[unit]
    rows = stamped(*[(start + t) * per_second for t in (0.0, 0.5, 1.25)])
    times = [one.t for one in scenario(tmp_path, rows, f'time = "relative"\ntime_unit = "{unit}"')]
    assert times == pytest.approx([0.0, 0.5, 1.25], abs=1e-6)


def test_absolute_is_a_word_for_it(tmp_path: Path) -> None:
    """A file that goes on much longer than the run is run where `time = "absolute"` says that it is meant so."""
    stamps = tuple(float(k) for k in range(0, 1500, 20))
    assert len(scenario(tmp_path, stamped(*stamps), 'time = "absolute"')) == len(stamps)
    with pytest.raises(ScenarioError, match="after the end of the run"):
        scenario(tmp_path, stamped(4.0), 'time = "absolute"')


@pytest.mark.parametrize(
    ("rows", "line"),
    [
        ("t,v_c,w_c\n0.0,0.1,0.0\n0.5,0.1,0.0\n0.5,0.2,0.0\n", "line 4: its time 0.5 is not after 0.5 of line 3"),
        ("t,v_c,w_c\n\n0.0,0.1,0.0\n ,,\n0.0,0.2,0.0\n", "line 5: its time 0.0 is not after 0 of line 3"),
        ("t,v_c,w_c\n0.7,0.1,0.0\n0.2,0.1,0.0\n", "line 3: its time 0.2 is not after 0.7 of line 2"),
        ("t;v_c;w_c\n0,1;0,1;0\n", "separate the columns by commas"),
        ("", "an empty file"),
    ],
)
def test_rows_out_of_order_are_named_by_line(tmp_path: Path, rows: str, line: str) -> None:
    """Stamps that repeat or go back are reported by the lines in the file; empty lines count, and mean nothing."""
    with pytest.raises(ScenarioError, match=line):
        scenario(tmp_path, rows)


@pytest.mark.parametrize(
    ("segments", "found"),
    [
        ("[{t = 5.0, v_c = 0.1, w_c = 0.0}]", "no command would be carried out"),
        ("[{t = 1764075000.0, v_c = 0.1, w_c = 0.0}]", "seconds since 1970"),
        ("[{t = 0.0, v_c = 0.1, w_c = 0.0}, {t = 0.0, v_c = 0.1, w_c = 0.0}]", "entry 2 is not after 0"),
    ],
)
def test_the_same_care_for_the_table(tmp_path: Path, segments: str, found: str) -> None:
    """Commands in the scenario itself are looked at in the same way."""
    (tmp_path / "s.toml").write_text(f"[command]\nduration = 3.0\nsegments = {segments}\n")
    with pytest.raises(ScenarioError, match=found):
        load_scenario(tmp_path / "s.toml")
