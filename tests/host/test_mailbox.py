from __future__ import annotations

import os
import subprocess
import sys
import zlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from overreach.host.mailbox import HEADER, SLOT, Mailbox, shared_memory
from tests.processes import until


def pair() -> tuple[Mailbox, Mailbox]:
    """Return a writer and a reader."""
    descriptor = shared_memory()
    try:
        return Mailbox(descriptor), Mailbox(descriptor)
    finally:
        os.close(descriptor)


@given(st.lists(st.lists(st.binary(max_size=200), max_size=4), max_size=12))
def test_the_newest_is_read_once(rounds: list[list[bytes]]) -> None:
    """Whatever was put between two looks: the last of it is there, once; of nothing, nothing."""
    writer, reader = pair()
    for messages in rounds:
        for message in messages:
            writer.put(message)
        assert reader.get() == (messages[-1] if messages else None)
        assert reader.get() is None
    writer.close()
    reader.close()


@given(st.integers(1, 5), st.integers(0, HEADER.size + 59), st.integers(1, 255))
def test_half_a_message_does_not_count(before: int, at: int, flip: int) -> None:
    """A message of which any byte is not there yet, or another's, is not read; the one before it still is."""
    writer, reader = pair()
    for k in range(before):
        writer.put(b"%060d" % k)
    slot = (before & 1) * SLOT
    writer._memory[slot + at] ^= flip
    found = reader.get()
    assert found == (b"%060d" % (before - 2) if before > 1 else None)
    writer._memory[slot + at] ^= flip
    assert reader.get() == b"%060d" % (before - 1)


def test_what_is_too_long_is_refused() -> None:
    """A message that does not fit raises, and what was there before is still to be read."""
    writer, reader = pair()
    writer.put(b"before")
    with pytest.raises(ValueError, match="8193 bytes; at most 8176 fit"):
        writer.put(b"x" * 8193)
    assert reader.get() == b"before"
    writer.put(b"x" * 8176)
    assert reader.get() == b"x" * 8176


WRITER = """
import sys, zlib
from overreach.host.mailbox import Mailbox
box = Mailbox(int(sys.argv[1]))
k = 0
while True:
    k += 1
    body = b"%d " % k + bytes([k % 251]) * (k * 7919 % 3000)
    box.put(zlib.crc32(body).to_bytes(4, "big") + body)
"""


def test_two_processes_at_full_speed() -> None:
    """A reader beside a writer that never rests sees whole messages alone, and each newer than the one before."""
    descriptor = shared_memory()
    with subprocess.Popen([sys.executable, "-c", WRITER, str(descriptor)], pass_fds=[descriptor]) as writer:
        try:
            reader, last, seen = Mailbox(descriptor), 0, 0

            def read() -> bool:
                nonlocal last, seen
                for _ in range(2_000):
                    message = reader.get()
                    if message is not None:
                        assert zlib.crc32(message[4:]).to_bytes(4, "big") == message[:4]
                        number = int(message[4:].split(b" ", 1)[0])
                        assert number > last
                        last, seen = number, seen + 1
                return seen > 1_000

            until(read, what="1,000 messages")
        finally:
            writer.kill()
            os.close(descriptor)
