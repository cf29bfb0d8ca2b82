"""The reader of a telemetry ring: while it is written, or after; it never blocks the writer."""

import mmap
import os
from pathlib import Path
from typing import Self

import msgspec
import numpy as np
import numpy.typing as npt

from windup.hal.errors import TelemetryError
from windup.hal.publishing.run_state import RunState
from windup.hal.telemetry.file import read_head
from windup.hal.telemetry.header import Mark, RunNames
from windup.hal.telemetry.layout import (
    CHECK,
    CLOSED,
    CODE,
    NUMBER,
    REASON,
    RUNS,
    at,
    checksum,
)
from windup.hal.telemetry.text_slots import mark_slots, name_slots

TRIES = 3
"""Maximum number of reads of the newest tick, which may be overwritten meanwhile."""
Ticks = npt.NDArray[np.void]


class TelemetryReader:
    """Reads a ring.

    Args:
        path: Path of the file; see `ring_path`.

    Attributes:
        header: Header of the ring.
        lost: Number of ticks that `take` has missed because they were overwritten before.

    Raises:
        TelemetryError: There is no such file, or it is no ring of this version.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            with path.open("rb") as file:
                self._inode = os.fstat(file.fileno()).st_ino
                self._map = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        except FileNotFoundError:
            raise TelemetryError(f"{path}: there is no telemetry") from None
        except (OSError, ValueError) as error:
            raise TelemetryError(f"{path}: cannot be read: {error}") from None
        try:
            self.header, head = read_head(self._map)
            self._dtype = self.header.dtype()
        except (ValueError, msgspec.DecodeError) as error:
            self._map.close()
            raise TelemetryError(f"{path}: {error}") from None
        self._first, self._records = int(head["records_at"]), int(head["records"])
        self._names, self._marks = name_slots(self._map, head), mark_slots(self._map, head)
        self._next, self.lost, self._again = 1, 0, 0

    @property
    def sequence(self) -> int:
        """Number of the newest tick; 0 before any."""
        return self._number("sequence")

    @property
    def state(self) -> RunState:
        """State of the robot now, as its program has published it last."""
        return RunState(CODE.unpack_from(self._map, at("state"))[0])

    @property
    def ended(self) -> str | None:
        """Why the last run ended, or None while it goes on."""
        if CODE.unpack_from(self._map, at("phase"))[0] == RUNS:
            return None
        (reason,) = REASON.unpack_from(self._map, at("reason"))
        return reason.rstrip(b"\0").decode(errors="replace")

    @property
    def closed(self) -> bool:
        """True if the session that wrote the ring was closed."""
        return bool(CODE.unpack_from(self._map, at("phase"))[0] == CLOSED)

    @property
    def replaced(self) -> bool:
        """True if there is a newer ring, or none, at the path: this one will not be continued."""
        try:
            return self.path.stat().st_ino != self._inode
        except OSError:
            return True

    def latest(self) -> np.void | None:
        """Return the newest tick, or None before any; its fields are those of the header."""
        for _ in range(TRIES):
            if len(ticks := self.since(self.sequence - 1)):
                return ticks[-1]
        return None

    def since(self, sequence: int = 0) -> Ticks:
        """Return the ticks (m,) after tick `sequence` that the ring still holds, oldest first."""
        newest = self.sequence
        oldest = max(sequence + 1, newest - self._records + 1, 1)
        found = [data for s in range(oldest, newest + 1) if (data := self._record(s)) is not None]
        return np.frombuffer(b"".join(found), dtype=self._dtype)

    def take(self) -> Ticks:
        """Return the ticks (m,) since the last call, oldest first; `lost` counts those missed."""
        newest, found = self.sequence, list[bytes]()
        while self._next <= newest:
            data = self._record(self._next)
            if data is not None:
                found.append(data)
            elif self._is_unfinished():
                break
            else:
                self.lost += 1
            self._next += 1
        return np.frombuffer(b"".join(found), dtype=self._dtype)

    def names(self, run: int) -> RunNames | None:
        """Return the names that the controller of a run publishes.

        Args:
            run: Number of the run, as in the field `run` of its ticks.

        Returns:
            None if the ring does not hold them any more.
        """
        text = self._names.read(run)
        return None if text is None else msgspec.json.decode(text, type=RunNames)

    def marks(self, after: int = 0) -> list[Mark]:
        """Return the marks after mark number `after` that the ring still holds, oldest first."""
        newest = self._number("marks")
        numbers = range(max(after, newest - self._marks.count) + 1, newest + 1)
        texts = (self._marks.read(number) for number in numbers)
        return [msgspec.json.decode(text, type=Mark) for text in texts if text is not None]

    def close(self) -> None:
        """Release the memory map."""
        self._map.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def _number(self, name: str) -> int:
        return int(NUMBER.unpack_from(self._map, at(name))[0])

    def _is_unfinished(self) -> bool:
        """Return whether the next record is not being overwritten, but is not whole yet either.

        On some computers the number of the newest tick may be seen before all of its record. A
        record that is not whole at the next call either is damaged.
        """
        if self.sequence - self._next >= self._records - 1 or self._again == self._next:
            return False
        self._again = self._next
        return True

    def _record(self, sequence: int) -> bytes | None:
        """Return the bytes of a tick; None if they are overwritten, or just being written."""
        size = self._dtype.itemsize
        start = self._first + (sequence % self._records) * size
        data = self._map[start : start + size]
        found, check = CHECK.unpack_from(data)
        if found != sequence or NUMBER.unpack_from(self._map, start)[0] != sequence:
            return None
        return data if check == checksum(sequence, data[CHECK.size :]) else None
