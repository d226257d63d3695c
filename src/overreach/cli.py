"""The command line: help and version at once, every command through `overreach.commands`.

Help does not import the typed commands: their library takes longer to import than help may take to print.
"""

from __future__ import annotations

import os
import sys

from overreach import __version__
from overreach.errors import OverreachError

HELP = f"""\
overreach {__version__}: drive a whole mobile manipulator by its hand.

  overreach drive                a simulated robot and a page to drive it with
  overreach simulate outward     run a scenario without a page (--out run.csv for the data)

  overreach reproduce --out DIR  the paper's figures, and what it does not show: one page, in a minute
  overreach bench                what a control step costs, beside the quadratic programs

  overreach describe MODEL       a first description of your robot, from its URDF or MJCF
  overreach workspace ROBOT      measure where its hand can go
  overreach check ROBOT          drive it by random command streams, and say what came of it

  overreach laws                 the laws, blends and command frames there are
  overreach robots               the robots there are
  overreach doctor               what is installed, what is missing, how to get it

  overreach robot --listen HOST:PORT       the two halves of drive,
  overreach cockpit --connect HOST:PORT    for two machines

Add --help to any command for its options.
"""

CUT_OFF = 141
"""Exit code of a command whose output was cut off: as if SIGPIPE had ended it."""


def main() -> None:
    """Entry point of `overreach`. Exit code 2 for a value that cannot be used, with one line that says why."""
    try:
        try:
            _run(sys.argv[1:])
        finally:
            if sys.stdout is not None:
                sys.stdout.flush()
    except BrokenPipeError:  # whoever read our output has gone, as `head` does: that is no error of ours
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise SystemExit(CUT_OFF) from None


def _run(arguments: list[str]) -> None:
    if arguments in ([], ["help"], ["--help"], ["-h"]):
        print(HELP, end="")
        return
    if arguments in (["--version"], ["version"]):
        print(f"overreach {__version__}")
        return
    from overreach.commands import app

    try:
        app.cli(prog="overreach", args=arguments, sort_subcommands=False)
    except OverreachError as error:
        print(f"overreach: {error}", file=sys.stderr)
        raise SystemExit(2) from None
    except KeyboardInterrupt:
        raise SystemExit(130) from None
