"""The newest message from one process to another, in shared memory: a reader never waits, and sees no half of one.

There are two slots, written in turn. Each holds number, length and check sum of its message before the message: what a
writer was in the middle of, or was killed in the middle of, does not count, and the one before it still does.
"""

from __future__ import annotations

import mmap
import os
import struct
import tempfile
from typing import final
from zlib import crc32

SLOT = 8192
"""Bytes of one slot."""
HEADER = struct.Struct("<QII")


def shared_memory() -> int:
    """Return the file descriptor of new memory for one `Mailbox`: it has no name, and goes with its last process."""
    if hasattr(os, "memfd_create"):
        descriptor = os.memfd_create("overreach")
    else:
        with tempfile.TemporaryFile() as file:
            descriptor = os.dup(file.fileno())
    os.ftruncate(descriptor, 2 * SLOT)
    return descriptor


@final
class Mailbox:
    """One end, of the writer or of the reader. descriptor: from `shared_memory`; this end does not close it."""

    def __init__(self, descriptor: int) -> None:
        self._memory = mmap.mmap(descriptor, 2 * SLOT)
        self._number = 0

    def put(self, message: bytes) -> None:
        """Make `message` the newest; raises ValueError where it is too long."""
        length = len(message)
        if length > SLOT - HEADER.size:
            raise ValueError(f"a message of {length} bytes; at most {SLOT - HEADER.size} fit")
        self._number = number = self._number + 1
        at = (number & 1) * SLOT
        end = at + HEADER.size
        self._memory[end : end + length] = message
        HEADER.pack_into(self._memory, at, number, length, _check(message, number))

    def get(self) -> bytes | None:
        """Return the newest whole message, if there has come one since the last call; else None."""
        memory = self._memory
        slots = [(*HEADER.unpack_from(memory, at), at + HEADER.size) for at in (0, SLOT)]
        if slots[0][0] < slots[1][0]:
            slots.reverse()
        for number, length, check, at in slots:
            if number <= self._number:
                return None
            message = memory[at : at + min(length, SLOT)]
            if _check(message, number) == check:
                self._number = number
                return message
        return None

    def close(self) -> None:
        """Let go of the memory."""
        self._memory.close()


def _check(message: bytes, number: int) -> int:
    """Return the check sum of a message with its number."""
    return crc32(message, crc32(number.to_bytes(8, "little")))
