from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from overreach.link.pace import AWAY_MOST, LOST_S, Pace
from overreach.types import Command
from tests.said import said


def stick(seq: int, held: bool = True, operator: int = 7) -> Command:
    return said(operator, seq, 1, held, 0.3, 0.0)


def test_few_are_on_their_way_and_the_newest_waits() -> None:
    """Three go out; of what comes then only the newest is kept, and it goes as soon as one was heard."""
    pace = Pace()
    assert [pace.send(stick(k), 10.0) is not None for k in range(1, 7)] == [True] * AWAY_MOST + [False] * 3
    assert pace.heard(7, 0, 10.01) is None
    next_ = pace.heard(7, 1, 10.02)
    assert next_ is not None
    assert next_.seq == 6
    assert pace.heard(7, 1, 10.02) is None
    assert pace.send(stick(7), 10.02) is None


def test_a_release_never_waits() -> None:
    """Letting go is sent at once, whatever is on its way; what waited is forgotten, and a press counts anew."""
    pace = Pace()
    for k in range(1, 6):
        pace.send(stick(k), 10.0)
    assert pace.send(stick(6, held=False), 10.0) is not None
    assert pace.heard(7, 6, 10.01) is None
    assert pace.send(stick(7), 10.02) is not None


def test_what_is_not_heard_is_given_up() -> None:
    """An operator who is not heard, as one who has not armed, is slowed down and not silenced."""
    pace = Pace()
    sent = [k * 0.016 for k in range(1, 200) if pace.send(stick(k), k * 0.016) is not None]
    assert AWAY_MOST * 3.2 / LOST_S * 0.7 < len(sent) <= AWAY_MOST * 3.2 / LOST_S + AWAY_MOST


def test_operators_do_not_slow_each_other_down() -> None:
    """Each operator has its own three."""
    pace = Pace()
    for operator in (1, 2, 3):
        for k in range(1, AWAY_MOST + 1):
            assert pace.send(stick(k, operator=operator), 5.0) is not None


@given(st.lists(st.tuples(st.sampled_from(["send", "heard", "release"]), st.floats(0.0, 0.1)), max_size=80))
def test_in_any_order(acts: list[tuple[str, float]]) -> None:
    """What goes out is in the order of its numbers, never more than three within the patience, and never twice."""
    pace, now, seq, heard = Pace(), 1.0, 0, 0
    out: list[tuple[int, float, bool]] = []
    for act, gap in acts:
        now += gap
        if act == "heard":
            heard = out[-1][0] if out else 0
            sent = pace.heard(7, heard, now)
        else:
            seq += 1
            sent = pace.send(stick(seq, act == "send"), now)
        if sent is not None:
            out.append((sent.seq, now, sent.held))
        released = max((n for n, _, held in out if not held), default=0)
        away = [n for n, at, held in out if held and n > max(heard, released) and now - at <= LOST_S]
        assert len(away) <= AWAY_MOST
    numbers = [n for n, _, _ in out]
    assert numbers == sorted(set(numbers))
