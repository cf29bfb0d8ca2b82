"""A queue of texts in shared memory, with one writer and one reader, neither of which waits."""

import mmap
import struct
import zlib
from typing import Final

HEAD: Final = struct.Struct("=II")
"""Length of a text, and its CRC-32."""


class TextQueue:
    """A queue in a part of a memory map.

    Args:
        memory: The map.
        words: Its first part as 64-bit words.
        written: Index of the word that counts the texts written.
        read: Index of the word that counts the texts read.
        start: Offset of the first slot, bytes.
        slots: Number of slots.
        size: Size of a slot, bytes.
    """

    def __init__(
        self,
        memory: mmap.mmap,
        words: "memoryview[int]",
        written: int,
        read: int,
        start: int,
        slots: int,
        size: int,
    ) -> None:
        self._memory, self._words = memory, words
        self._written, self._read = written, read
        self._start, self._slots, self._size = start, slots, size

    @property
    def room(self) -> int:
        """Maximum length of a text, bytes."""
        return self._size - HEAD.size

    def put(self, text: bytes) -> bool:
        """Append a text; return False if it is too long, or the reader is too far behind."""
        number = self._words[self._written]
        if len(text) > self.room or number - self._words[self._read] >= self._slots:
            return False
        at = self._at(number)
        HEAD.pack_into(self._memory, at, len(text), zlib.crc32(text))
        self._memory[at + HEAD.size : at + HEAD.size + len(text)] = text
        self._words[self._written] = number + 1
        return True

    @property
    def waiting(self) -> bool:
        """True when there is a text to take."""
        return self._words[self._written] != self._words[self._read]

    def take(self) -> bytes | None:
        """Return the oldest text that was not taken yet, or None."""
        number = self._words[self._read]
        if self._words[self._written] == number:
            return None
        at = self._at(number)
        length, check = HEAD.unpack_from(self._memory, at)
        text = self._memory[at + HEAD.size : at + HEAD.size + min(length, self.room)]
        if zlib.crc32(text) != check:
            return None  # not all of it is there yet; the next look finds it
        self._words[self._read] = number + 1
        return text

    def _at(self, number: int) -> int:
        return self._start + (number % self._slots) * self._size
