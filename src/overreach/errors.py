"""Set-up errors: raised before anything moves, never from inside the loop.

    OverreachError
    ├── SetupError (ValueError)       a value that cannot be used
    │   ├── WorkspaceError            limits of the workspace out of order or out of reach
    │   ├── ScenarioError             a scenario file that cannot be run
    │   ├── UnknownNameError          a name that nothing answers to
    │   └── MissingExtraError         a library that is not installed, with the line that brings it
    └── LinkError                     the other half cannot be reached or does not fit

Each message is one line: what is wrong, what was given, what is valid, what to do.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable

LONGEST_NAME = 60
"""A name longer than this is cut before it is compared and shown."""
LONGEST_TOLD = 160
"""The text of a third-party exception is cut after this many characters."""


def told(error: BaseException) -> str:
    """Return what any exception says, its type first, as one line of at most LONGEST_TOLD characters."""
    try:
        text = " ".join(f"{type(error).__name__}: {error}".split())
        text = text.encode("utf-8", "backslashreplace").decode()  # what cannot be sent cannot be told
    except Exception:  # its own text cannot be read
        text = type(error).__name__
    return text if len(text) <= LONGEST_TOLD else f"{text[:LONGEST_TOLD]}..."


class OverreachError(Exception):
    """Base of every error that overreach raises on purpose."""


class SetupError(OverreachError, ValueError):
    """A value given at set-up cannot be used."""


class WorkspaceError(SetupError):
    """The workspace's limits are out of order, not finite, or out of the arm's reach."""


class ScenarioError(SetupError):
    """A scenario cannot be read or run."""


class UnknownNameError(SetupError):
    """A name is not one of the valid choices; the message suggests the nearest."""

    def __init__(self, kind: str, got: str, valid: Iterable[str], more: str = "") -> None:
        self.valid = sorted(valid)
        got = got if len(got) <= LONGEST_NAME else f"{got[:LONGEST_NAME]}..."
        near = difflib.get_close_matches(got, self.valid, n=1)
        hint = f" Did you mean {near[0]!r}?" if near else ""
        super().__init__(f"unknown {kind} {got!r}.{hint} Valid: {', '.join(self.valid)}.{more and ' '}{more}")


class MissingExtraError(SetupError):
    """A library that a part of overreach needs is not installed; the message has the pip line."""


class LinkError(OverreachError):
    """The other half (robot side or operator side) cannot be reached or does not fit this one."""
