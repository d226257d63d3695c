"""What this machine has, what it lacks, and the line that installs it."""

from __future__ import annotations

import os
import platform
import shutil
import sys
from importlib.metadata import PackageNotFoundError, version

from overreach import __version__
from overreach.extras import pip_line

NEEDED = {
    "nicegui": "the page",
    "eclipse-zenoh": "the link between the halves",
    "msgspec": "messages",
    "mujoco-core": "robots from their own models",
    "numpy": "robots from their own models",
    "tyro": "this command line",
}
OPTIONAL = {
    "figures": ("matplotlib", "reproduce"),
    "qp": ("qpsolvers", "the laws qp and holistic, reproduce, bench"),
    "fast": ("numba", "compiled steps, bench"),
    "models": ("mujoco-menagerie", "the robot tiago"),
    "stretch": ("hello-robot-stretch-urdf", "the robot stretch"),
    "peers": ("mink", "bench --robot"),
}
"""Extras: the package that tells whether it is there, and what it is for."""
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "firefox", "xdg-open", "open")


def _line(good: bool, what: str, found: str, remedy: str = "") -> str:
    mark = "ok     " if good else "missing"
    return f"  {mark}  {what:<26}{found}" + (f"  ->  {remedy}" if not good and remedy else "")


def _package(name: str, job: str) -> str:
    try:
        return _line(True, name, f"{version(name)}  ({job})")
    except PackageNotFoundError:
        return _line(False, name, f"({job})", f"pip install {name}")


def _extra(extra: str, package: str, job: str) -> str:
    try:
        return _line(True, package, f"{version(package)}  ({job})")
    except PackageNotFoundError:
        return f"  not in   {package:<26}({job})  ->  {pip_line(extra)}"


def _one_mujoco() -> list[str]:
    """Return a line where a whole MuJoCo of another version lies in the same folder: the two overwrite each other."""
    try:
        whole, core = version("mujoco"), version("mujoco-core")
    except PackageNotFoundError:
        return []
    if whole == core:
        return []
    return [_line(False, "one mujoco", f"mujoco {whole} beside mujoco-core {core}", f"pip install mujoco=={core}")]


def _real_time() -> str:
    try:
        before = os.sched_getscheduler(0)
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
        os.sched_setscheduler(0, before, os.sched_param(0))
    except (AttributeError, OSError):
        return _line(
            False,
            "SCHED_FIFO",
            "not permitted: the loop may be some ms late on a busy machine",
            "give your user rtprio in /etc/security/limits.conf",
        )
    return _line(True, "SCHED_FIFO", "permitted: the loop keeps its time on a busy machine")


def report() -> str:
    """Return the report as text."""
    python_fits = sys.version_info >= (3, 11)
    browser = next((name for name in BROWSERS if shutil.which(name)), None)
    lines = [
        f"overreach {__version__} on {platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        _line(python_fits, "python", platform.python_version(), "install Python 3.11 or newer"),
        *(_package(name, job) for name, job in NEEDED.items()),
        *_one_mujoco(),
        *(_extra(extra, *what) for extra, what in OPTIONAL.items()),
        _line(browser is not None, "browser", browser or "none found", "open the printed address elsewhere"),
        _real_time(),
    ]
    return "\n".join(lines)
