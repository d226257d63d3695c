"""`python -m benchmarks [NAME ...] [--json FILE]`: measure, and say for each promise whether it is kept."""

from __future__ import annotations

import json
import platform
import sys
from importlib import import_module
from pathlib import Path

from benchmarks.measure import Promise

NAMES = ("law", "startup", "loop", "hosted", "pad", "resources")


def main() -> None:
    """Run the benchmarks named, or all."""
    words = sys.argv[1:]
    target = Path(words.pop(words.index("--json") + 1)) if "--json" in words else None
    names = [word for word in words if word != "--json"] or list(NAMES)
    if unknown := set(names) - set(NAMES):
        print(f"unknown benchmark {sorted(unknown)}; valid: {', '.join(NAMES)}", file=sys.stderr)
        raise SystemExit(2)
    print(f"{platform.machine()}, {platform.system()} {platform.release()}, Python {platform.python_version()}\n")
    kept: list[Promise] = []
    for name in names:
        for promise in import_module(f"benchmarks.{name}").run():
            print(promise.line(), flush=True)
            kept.append(promise)
    missed = [promise for promise in kept if promise.kept is False]
    promised = [promise for promise in kept if promise.kept is not None]
    print(f"\n{len(promised) - len(missed)} of {len(promised)} as promised" + ("; missed:" if missed else ""))
    for promise in missed:
        print(promise.line())
    if target:
        target.write_text(json.dumps([promise.as_dict() for promise in kept], indent=2))


main()
