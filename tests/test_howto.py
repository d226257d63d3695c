"""docs/your_robot.md, followed to the letter: from a URDF in a public wheel to driving it."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest

from overreach.link.endpoint import free_port

PAGE = Path(__file__).parents[1] / "docs" / "your_robot.md"
BLOCK = re.compile(r"^```(sh|toml)\n(.*?)^```", re.DOTALL | re.MULTILINE)
LONGEST_S = 600


def blocks() -> list[tuple[str, str]]:
    """Return the page's blocks in order: kind and text."""
    return BLOCK.findall(PAGE.read_text("utf-8"))


@pytest.fixture
def env(tmp_path: Path) -> dict[str, str]:
    """A newcomer's surroundings: an empty home, no display, the environment that overreach is installed in."""
    home = tmp_path / "home"
    home.mkdir()
    own = str(Path(sys.executable).parent)
    kept = {key: os.environ[key] for key in ("PIP_INDEX_URL", "PIP_CONFIG_FILE", "LANG") if key in os.environ}
    return {**kept, "HOME": str(home), "PATH": f"{own}:/usr/bin:/bin", "BROWSER": "true"}


def run(line: str, folder: Path, env: dict[str, str]) -> str:
    """Run a line as it stands, and return what it said."""
    ended = subprocess.run(
        ["bash", "-c", line], cwd=folder, env=env, capture_output=True, text=True, timeout=LONGEST_S, check=False
    )
    assert ended.returncode == 0, f"{line}\n{ended.stdout}\n{ended.stderr}"
    return ended.stdout


def edited(text: str, changes: str) -> str:
    """Return a TOML with the lines of `changes` in the place of those that have their names, table by table."""
    lines = text.splitlines()
    table = ""
    for change in filter(None, changes.splitlines()):
        if change.startswith("["):
            table = change
            continue
        name = change.partition(" = ")[0]
        at, inside = -1, ""
        for k, line in enumerate(lines):
            inside = line if line.startswith("[") else inside
            if inside == table and line.startswith(f"{name} = "):
                at = k
        assert at >= 0, change
        lines[at] = change
    return "\n".join(lines) + "\n"


@pytest.fixture
def driving(tmp_path: Path, env: dict[str, str]) -> Iterator[list[subprocess.Popen[str]]]:
    """What was started, to be ended."""
    started: list[subprocess.Popen[str]] = []
    yield started
    for process in started:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGINT)
            process.wait(30)


def test_ten_minutes(tmp_path: Path, env: dict[str, str], driving: list[subprocess.Popen[str]]) -> None:
    """Every command runs, the robot's smooth steps are 0.9999 OK, and its page answers."""
    found = blocks()
    toml = tmp_path / "fetch.toml"
    lines = [(kind, line) for kind, text in found for line in ([text] if kind == "toml" else text.splitlines())]
    said = ""
    for kind, line in lines:
        if kind == "toml":
            toml.write_text(edited(toml.read_text(), line))
        elif line.startswith("overreach drive"):
            _drive(line, tmp_path, env, driving)
        else:
            said = run(line, tmp_path, env)
        if "--find-home" in line:
            home = [one for one in said.splitlines() if re.fullmatch(r"home = \[.*\]", one)][-1]
            toml.write_text(edited(toml.read_text(), home))
        if line.startswith("overreach check"):
            shown = re.search(r"steps that are OK +(\S+) +(\S+)", said)
            assert shown
            assert float(shown.group(1)) >= 0.9999
            assert float(shown.group(2)) >= 0.995
            assert re.search(r"joint limits passed +0 +0", said)
            assert re.search(r"contacts with itself +0 +0", said)
    assert (tmp_path / "fetch.svg").stat().st_size > 10_000
    assert [kind for kind, _ in found].count("toml") == 1
    shutil.rmtree(tmp_path / "wheel")  # hundreds of MB


def _drive(line: str, folder: Path, env: dict[str, str], driving: list[subprocess.Popen[str]]) -> None:
    """Run the line that drives; wait for its page, and see that it is the page."""
    port = free_port()
    process = subprocess.Popen(
        ["bash", "-c", f"exec {line} --port {port}"], cwd=folder, env=env, stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    driving.append(process)
    end = time.monotonic() + 120.0
    while True:
        assert process.poll() is None, process.stderr and process.stderr.read()
        assert time.monotonic() < end, "the page has not come up within two minutes"
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=5) as page:
                assert b"overreach" in page.read()
            return
        except OSError:
            time.sleep(0.2)


def test_edits_go_where_they_belong() -> None:
    """A line of a table takes the place of that table's, not of another's with the same name."""
    text = "name = 1\n[a]\nv = 1  # guessed\n[b]\nv = 2\n"
    assert edited(text, "name = 3\n\n[b]\nv = 4\n") == "name = 3\n[a]\nv = 1  # guessed\n[b]\nv = 4\n"
    with pytest.raises(AssertionError):
        edited(text, "[a]\nw = 1\n")
