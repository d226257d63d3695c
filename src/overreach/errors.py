"""Set-up errors: raised before anything moves, never from inside the loop.

    OverreachError
    ├── SetupError (ValueError)       a value that cannot be used
    │   ├── WorkspaceError            limits of the workspace out of order or out of reach
    │   ├── ScenarioError             a scenario file that cannot be run
    │   └── UnknownNameError          a name that nothing answers to
    ├── MissingExtraError             an optional dependency is not installed
    └── LinkError                     the other half cannot be reached or does not fit

Each message is one line: what was wrong, what was got, what is valid, what to do.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable


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

    def __init__(self, kind: str, got: str, valid: Iterable[str]) -> None:
        self.valid = sorted(valid)
        near = difflib.get_close_matches(got, self.valid, n=1)
        hint = f" Did you mean {near[0]!r}?" if near else ""
        super().__init__(f"unknown {kind} {got!r}.{hint} Valid: {', '.join(self.valid)}.")


class MissingExtraError(OverreachError):
    """An optional dependency is missing; the message holds the pip line that brings it."""

    def __init__(self, what: str, extra: str) -> None:
        super().__init__(f"{what} is not installed: pip install 'overreach[{extra}]'")


class LinkError(OverreachError):
    """The other half (robot side or operator side) cannot be reached or does not fit this one."""
