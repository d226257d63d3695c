from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests import robots_check as robots

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text("utf-8")


def python(*arguments: str, cwd: Path | None = None, path: Path | None = None) -> str:
    environment = {**os.environ, **({"PYTHONPATH": str(path)} if path else {})}
    done = subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, check=False, cwd=cwd, env=environment, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("example", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.name)
def test_examples_run(example: Path) -> None:
    """Every example runs and says something."""
    assert python(str(example))


def test_readme_code_prints_what_it_says() -> None:
    """The README's code, about twelve lines of it, prints exactly the output that stands below it."""
    code, output = re.search(r"```python\n(.*?)```\n\n```text\n(.*?)```", README, re.S).groups()  # type: ignore[union-attr]
    assert 10 <= len([line for line in code.splitlines() if line.strip()]) <= 14
    assert python("-c", code) == output


def test_readme_numbers_are_measured() -> None:
    """The errors of the laws that the README quotes are those that the simulation gives."""
    import overreach

    for law in ("paper", "exact"):
        error = overreach.simulate("aside", law).summary.ee_error_max
        assert f"{error:.3f}" in README


def test_what_the_robots_came_to_is_in_the_file() -> None:
    """The table of docs/robots.md is that of build/robots.json, to the letter: a run has written it."""
    report = json.loads(robots.FILE.read_text())
    assert all(re.fullmatch(r"[0-9a-f]{40}", one["commit"]) for one in (*report["found"], *report["guessed"]))
    assert robots.parts(robots.PAGE.read_text("utf-8"))[1] == robots.table(report)


def test_links_lead_somewhere() -> None:
    """Every file that a document of ours links to is there."""
    for document in [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]:
        for target in re.findall(r"\]\(([^)#:]+)\)", document.read_text("utf-8")):
            assert (document.parent / target).exists(), f"{document.name}: {target}"


def test_functions_named_in_the_docs_exist() -> None:
    """The table from equations to functions names functions that there are."""
    from importlib import import_module

    rows = re.findall(r"^\|.*\| (`.*`) \|$", (ROOT / "docs" / "why.md").read_text("utf-8"), re.M)
    assert len(rows) >= 7
    for row in rows:
        names = re.findall(r"`([\w.]+)`", row)
        home = names[0].rsplit(".", 1)[0]
        for name in names:
            module, _, function = (name if "." in name else f"{home}.{name}").rpartition(".")
            assert hasattr(import_module(f"overreach.{module}"), function), name


def test_the_wheel_is_whole(tmp_path: Path) -> None:
    """The built wheel has the page, the robots, the scenarios and the types, and runs without the source tree."""
    python("-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "-w", str(tmp_path), str(ROOT))
    (wheel,) = tmp_path.glob("*.whl")
    site = tmp_path / "site"
    with zipfile.ZipFile(wheel) as archive:
        inside = set(archive.namelist())
        archive.extractall(site)
    source = ROOT / "src"
    wanted = {
        str(path.relative_to(source))
        for path in (source / "overreach").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert wanted <= inside
    where = "import overreach; print(overreach.__file__)"
    assert python("-c", where, cwd=tmp_path, path=site).startswith(str(site))
    assert "EE velocity error" in python("-m", "overreach", "simulate", "outward", cwd=tmp_path, path=site)


def test_no_index_and_no_lock() -> None:
    """Nothing in the repository names a package index, and there is no lock file."""
    tracked = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=True, cwd=ROOT).stdout.split()
    assert not [name for name in tracked if re.search(r"(uv|poetry|Pipfile)\.lock$|pylock", name)]
    for name in tracked:
        if not name.endswith(".png"):
            text = (ROOT / name).read_text("utf-8")
            assert not re.search(r"index" + r"-url|pypi" + r"\.org|files\.python" + r"hosted", text), name
