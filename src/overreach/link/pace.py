"""How many commands may be on their way to the robot side: the newest waits its turn, and is never a queue."""

from __future__ import annotations

from collections import deque
from typing import final

from overreach.types import Command

AWAY_MOST = 3
"""Held commands of one operator that the robot side has not heard yet."""
LOST_S = 0.15
"""One that was not heard for this long [s] does not count any more: it was dropped, or that operator is not heard."""


@final
class Pace:
    """Says which commands may go out now. Not for two threads at once."""

    def __init__(self) -> None:
        self._away: dict[int, deque[tuple[int, float]]] = {}
        self._waiting: dict[int, Command] = {}

    def send(self, command: Command, now: float) -> Command | None:
        """Return what to send of a new `command`: itself or, while it must wait, nothing. A release never waits."""
        operator = command.operator
        self._waiting.pop(operator, None)
        if not command.held:
            self._away.pop(operator, None)
            return command
        if self._full(operator, now):
            self._waiting[operator] = command
            return None
        return self._sent(command, now)

    def heard(self, operator: int, seq: int, now: float) -> Command | None:
        """Return the command of `operator` that may go out now that the robot side has heard all up to `seq`."""
        away = self._away.get(operator)
        while away and away[0][0] <= seq:
            away.popleft()
        if operator not in self._waiting or self._full(operator, now):
            return None
        return self._sent(self._waiting.pop(operator), now)

    def _full(self, operator: int, now: float) -> bool:
        away = self._away.setdefault(operator, deque())
        while away and now - away[0][1] > LOST_S:
            away.popleft()
        return len(away) >= AWAY_MOST

    def _sent(self, command: Command, now: float) -> Command:
        self._away[command.operator].append((command.seq, now))
        return command
