"""A part of a telemetry ring that holds the last few texts: names of runs, or marks.

Text n is in slot n modulo the number of slots, which begins with that number, the size of the text
and its checksum.
"""

import mmap

import numpy as np

from windup.hal.errors import TelemetryError
from windup.hal.telemetry.layout import NUMBER, SLOT, checksum


class TextSlots:
    """The slots of one part of a ring.

    Args:
        ring: Memory map of the file.
        start: Offset of the first slot, bytes.
        count: Number of slots.
        size: Size of a slot, bytes.
    """

    def __init__(self, ring: mmap.mmap, start: int, count: int, size: int) -> None:
        self._ring, self._start, self.count, self._size = ring, start, count, size

    @property
    def room(self) -> int:
        """Maximum size of a text, bytes."""
        return self._size - SLOT.size

    def write(self, number: int, text: bytes) -> None:
        """Write text `number`, in place of the oldest one.

        Raises:
            TelemetryError: It is too long.
        """
        if len(text) > self.room:
            raise TelemetryError(
                f"the names that a controller publishes take {len(text)} bytes; "
                f"at most {self.room} fit"
            )
        start = self._at(number)
        NUMBER.pack_into(self._ring, start, 0)
        begin = start + SLOT.size
        self._ring[begin : begin + len(text)] = text
        SLOT.pack_into(self._ring, start, 0, len(text), checksum(number, text))
        NUMBER.pack_into(self._ring, start, number)

    def read(self, number: int) -> bytes | None:
        """Return text `number`, or None if it has been overwritten or is being written."""
        if number < 1:
            return None
        start = self._at(number)
        found, size, check = SLOT.unpack_from(self._ring, start)
        if found != number or size > self.room:
            return None
        text = self._ring[start + SLOT.size : start + SLOT.size + size]
        again, *_ = SLOT.unpack_from(self._ring, start)
        return text if again == number and check == checksum(number, text) else None

    def _at(self, number: int) -> int:
        return self._start + (number % self.count) * self._size


def name_slots(ring: mmap.mmap, head: np.void) -> TextSlots:
    """Return the slots of the names of the last runs."""
    place = (head["names_at"], head["name_slots"], head["name_size"])
    return TextSlots(ring, *map(int, place))


def mark_slots(ring: mmap.mmap, head: np.void) -> TextSlots:
    """Return the slots of the last marks."""
    place = (head["marks_at"], head["mark_slots"], head["mark_size"])
    return TextSlots(ring, *map(int, place))
