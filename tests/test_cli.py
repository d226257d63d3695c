from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from overreach.cli import HELP

COLUMNS = "t,v_c,w_c,l,psi,theta_e,mu,sigma,v_b,v_bm,v_m,w_b,w_m,x_b,y_b,theta_b,x_e,y_e,theta_1,theta_2"


def overreach(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "overreach", *arguments],
        capture_output=True, text=True, check=False, cwd=cwd, timeout=60, env={**os.environ, "COLUMNS": "100"},
    )  # fmt: skip


def test_alone_it_leads_with_drive() -> None:
    """`overreach` alone and `overreach --help` say what there is, `drive` first."""
    alone, asked = overreach(), overreach("--help")
    assert alone.returncode == asked.returncode == 0
    assert alone.stdout == asked.stdout == HELP
    commands = [line.split()[1] for line in HELP.splitlines() if line.startswith("  overreach ")]
    assert commands[0] == "drive"


def test_help_names_every_command() -> None:
    """Every command is in the short help, and no other; each has a help of its own."""
    from overreach.commands import app

    named = {line.split()[1] for line in HELP.splitlines() if line.startswith("  overreach ")}
    assert named == set(app._subcommands)
    for command in named:
        done = overreach(command, "--help")
        assert done.returncode == 0, done.stderr
        assert "usage: overreach" in done.stdout


def test_help_does_not_import_the_heavy_parts() -> None:
    """`--help` imports neither the page's library, nor the wire's, nor the typed command line."""
    code = "import sys; sys.argv = ['overreach', '--help']; from overreach.cli import main; main(); print(*sys.modules)"
    modules = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not {"nicegui", "zenoh", "tyro", "msgspec", "numpy"} & set(modules)


def test_simulate_writes_the_csv(tmp_path: Path) -> None:
    """The CSV has exactly the columns, one row a step, and numbers that round-trip."""
    out = tmp_path / "run.csv"
    done = overreach("simulate", "outward", "--law", "paper", "--out", str(out), "--json")
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    with out.open(newline="") as stream:
        header, *rows = csv.reader(stream)
    assert ",".join(header) == COLUMNS
    assert len(rows) == summary["steps"] == 12_000
    assert float(rows[1][0]) == 0.001
    assert all(len(row) == len(header) for row in rows)
    assert [path.name for path in tmp_path.iterdir()] == ["run.csv"]


def test_simulate_prints_a_table() -> None:
    """Without --json a table says what happened, with units."""
    done = overreach("simulate", "aside")
    assert done.returncode == 0
    for words in (
        "EE velocity error, max",
        "base path",
        "time outside the workspace",
        "authority changes",
        "m/s",
    ):
        assert words in done.stdout


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["simulate", "outwards"], "Did you mean 'outward'"),
        (["simulate", "missing.toml"], "no scenario file"),
        (["simulate", "bad.toml"], "Did you mean 'robot'"),
        (["simulate", "outward", "--law", "exakt"], "Did you mean 'exact'"),
        (["simulate", "outward", "--out", "no/where.csv"], "no folder"),
        (["simulate", "outward", "--out", "."], "is a folder"),
        (["simulate", "outward", "--out", "/proc/run.csv"], "cannot write in '/proc'"),
        (["simulate", "outward", "--out", "bad.toml/run.csv"], "is a file"),
        (["reproduce", "--out", "/proc/report"], "cannot write in '/proc'"),
        (["reproduce", "--out", "bad.toml"], "is a file"),
        (["bench", "--json", "no/where.json"], "no folder"),
        (["bench", "--json", "."], "is a folder"),
        (["robot", "plannar"], "Did you mean 'planar'"),
        (["robot", "--listen", "nonsense"], "HOST:PORT"),
        (["robot", "--rate", "5"], "50 to 1000 Hz"),
        (["drive", "--rate", "nan"], "50 to 1000 Hz"),
        (["drive", "--max-delay", "inf"], "0.1 to 2 s"),
        (["robot", "--max-delay", "0"], "0.1 to 2 s"),
        (["drive", "--host", ""], "--host must be"),
        (["drive", "plannar"], "Did you mean 'planar'"),
        (["drive", "--port", "99999"], "1 to 65535"),
        (["drive", "--host", "203.0.113.7", "--port", "8431"], "an address of this machine"),
        (["cockpit", "--connect", "127.0.0.1:0"], "HOST:PORT"),
    ],
)
def test_bad_input_gets_one_line_and_exit_code_2(arguments: list[str], says: str, tmp_path: Path) -> None:
    """What cannot be used is answered with one clear line on stderr and exit code 2, and nothing is written."""
    (tmp_path / "bad.toml").write_text("[robott]\nl = 0.5\n")
    if arguments[0] == "simulate" and "--out" not in arguments:
        arguments = [*arguments, "--out", "run.csv"]
    done = overreach(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert says in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert done.stdout == ""
    assert [path.name for path in tmp_path.iterdir()] == ["bad.toml"]


@pytest.mark.parametrize("arguments", [["fly"], ["simulate"], ["simulate", "outward", "--lww", "exact"]])
def test_bad_usage_is_exit_code_2(arguments: list[str]) -> None:
    """An unknown command or option is exit code 2 and names what it did not know."""
    done = overreach(*arguments)
    assert done.returncode == 2
    assert done.stderr


def test_lists() -> None:
    """`laws`, `robots` and `doctor` name what there is."""
    laws, robots, doctor = (overreach(command).stdout for command in ("laws", "robots", "doctor"))
    assert all(name in laws for name in ("exact", "paper", "switch", "tanh", "smoothstep", "hand", "world"))
    assert "planar" in robots
    assert all(name in doctor for name in ("python", "nicegui", "eclipse-zenoh", "SCHED_FIFO"))


def test_two_mujocos_are_told(tmp_path: Path) -> None:
    """`doctor` says where another version of all of MuJoCo lies over the core that is used here, and what to do."""
    assert "one mujoco" not in overreach("doctor").stdout
    (folder := tmp_path / "mujoco-3.1.0.dist-info").mkdir()
    (folder / "METADATA").write_text("Metadata-Version: 2.1\nName: mujoco\nVersion: 3.1.0\n")
    done = subprocess.run(
        [sys.executable, "-m", "overreach", "doctor"], env=os.environ | {"PYTHONPATH": str(tmp_path)},
        stdout=subprocess.PIPE, text=True, check=True, timeout=60,
    )  # fmt: skip
    assert "mujoco 3.1.0 beside mujoco-core 4" in done.stdout
    assert "pip install mujoco==4" in done.stdout


def test_version() -> None:
    """`--version` prints the version of the package."""
    from overreach import __version__

    assert overreach("--version").stdout.strip() == f"overreach {__version__}"


@pytest.mark.parametrize("arguments", [["laws"], ["--help"], ["simulate", "outward", "--json"], ["simulate", "--help"]])
def test_output_that_is_cut_off_ends_quietly(arguments: list[str]) -> None:
    """Where the reader of a pipe has gone, as with `| head`, a command ends without a word."""
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [sys.executable, "-m", "overreach", *arguments],
        stdout=write, stderr=subprocess.PIPE, text=True, check=False, timeout=60,
    )  # fmt: skip
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.parametrize("name", ["", "http://robot", "robot:80", "ro bot", "-robot", "*", "a" * 300])
def test_a_host_name_that_is_none(name: str) -> None:
    """`--allow-host` takes a machine's name alone."""
    done = overreach("drive", "--no-browser", f"--allow-host={name}")
    assert done.returncode == 2
    assert done.stderr.startswith("overreach: --allow-host must be a machine's name alone, such as robot.local")
    assert done.stderr.count("\n") == 1
