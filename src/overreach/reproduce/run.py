"""`overreach reproduce`: all sections, two at a time; then the timing, alone; then the page and results.json."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from overreach.errors import SetupError
from overreach.extras import require
from overreach.files import try_to_write

if TYPE_CHECKING:
    from overreach.reproduce.lab import Section

NEEDED = "figures,qp"
SECTIONS = {
    "blending": 2, "scenarios": 8, "arbitrary": 3, "rivals": 8, "cost": 9,
    "creep": 5, "distortion": 1, "straight": 4, "chatter": 3, "parameters": 1,
}  # fmt: skip
"""In their order; with the seconds that each takes, about, for the progress bar."""
ALONE = "cost"
"""What measures time is done when nothing else runs."""
WORKERS = 2

Done = tuple["Section", dict[str, Any], dict[str, Any]]


def check_folder(out: Path) -> None:
    """Raise SetupError where `out` cannot become a folder of ours, before any work is done."""
    above = next(folder for folder in (out, *out.absolute().parents) if folder.exists())
    if not above.is_dir():
        raise SetupError(f"--out {str(out)!r}: {str(above)!r} is a file: name a folder")
    try_to_write(above, f"--out {str(out)!r}")


def reproduce(out: Path, progress: bool = True) -> dict[str, Any]:
    """Write report.html, headline.md, results.json, figures/ and data/ into `out` and return what results.json holds.

    Raises SetupError where `out` cannot be written, MissingExtraError without the extras figures and qp.
    """
    check_folder(out)
    for module in ("matplotlib", "scipy", "qpsolvers", "daqp"):
        require(module, NEEDED, "reproduce")
    bar = require("tqdm", NEEDED, "reproduce").tqdm(
        total=sum(SECTIONS.values()), disable=None if progress else True, leave=False,
        bar_format="{percentage:3.0f}% {bar:40} {desc}",
    )  # fmt: skip
    done: dict[str, Done] = {}

    def finished(name: str, result: Done) -> None:
        done[name] = result
        bar.set_description_str(f"{name} done, {len(done)} of {len(SECTIONS)}")
        bar.update(SECTIONS[name])

    with bar:
        bar.set_description_str("running scenarios")
        _side_by_side([name for name in SECTIONS if name != ALONE], out, finished)
        bar.set_description_str("timing every law and every solver, alone")
        finished(ALONE, work(ALONE, out))
        return _write(out, [done[name] for name in SECTIONS])


def work(name: str, out: Path) -> Done:
    """Do one section; return it with its results: physics and timing."""
    from overreach.reproduce.lab import Lab

    lab = Lab(out)
    section = import_module(f"overreach.reproduce.{name}").section(lab)
    return section, lab.physics, lab.timing


def _side_by_side(names: list[str], out: Path, finished: Any) -> None:
    """Do sections in processes of their own, the longest first."""
    fresh = multiprocessing.get_context("spawn")  # a fork would take threads along that are not its own
    before: Any = signal.SIG_DFL
    if threading.current_thread() is threading.main_thread():  # ended from outside, the workers are to end too
        before = signal.signal(signal.SIGTERM, _leave)
    pool = ProcessPoolExecutor(min(WORKERS, os.cpu_count() or 1), fresh, _leave_ctrl_c_to_the_parent)
    try:
        jobs = {pool.submit(work, name, out): name for name in sorted(names, key=lambda name: -SECTIONS[name])}
        for job in as_completed(jobs):
            finished(jobs[job], job.result())
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for child in multiprocessing.active_children():
            child.terminate()
            child.join(5.0)
        for part in out.rglob("*.part"):  # what a worker was writing
            part.unlink()
        raise
    finally:
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, before)
    pool.shutdown()


def _leave(number: int, _frame: object) -> None:
    raise SystemExit(128 + number)


def _leave_ctrl_c_to_the_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _write(out: Path, done: list[Done]) -> dict[str, Any]:
    from overreach.files import write_json, write_text
    from overreach.reproduce import page
    from overreach.reproduce.headline import headline

    results: dict[str, Any] = {"physics": {}, "timing": {}}
    for _, physics, timing in done:
        results["physics"] |= physics
        results["timing"] |= timing
    write_json(out / "results.json", results)
    write_text(out / "headline.md", headline(results))
    write_text(out / "report.html", page.html([section for section, _, _ in done], results))
    return results
