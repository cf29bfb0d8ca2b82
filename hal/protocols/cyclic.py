"""What all cyclic reads are: one request, n replies, and the last good bytes of each."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from typing import Protocol

import numpy as np
import numpy.typing as npt

from hal.joints import Mask
from hal.protocols.protocol2 import Span, Status
from hal.protocols.turns import in_turn, newest

NOBODY = -1
"""The id of a reply that is not what anybody was asked for."""

Bytes = npt.NDArray[np.uint8]
Index = npt.NDArray[np.intp]


class CyclicRead(ABC):
    """One request and the n replies to it.

    An answer that fits the expected layout to the byte is checked at once; anything else goes to
    the resynchronising parser of the protocol, which keeps the replies that are good.

    Attributes:
        spans: What is read of whom, in the order of the replies.
        request: The frame to send.
        length: Bytes of a complete answer.
        longest: Bytes of the longest answer there can be.
        valid: (n,) bool: who answered the last request.
        complete: Did all?
        owed: Ids that earlier requests may still be answered by, to the number of those; who asks
            keeps it.
        doubted: Ids whose replies may have been to an earlier request.
        confusable: Could a late answer pass for that to another request?
        error: (n,) error bytes, and what the properties below show: as of each servo's last
            good answer.
        payload: The parameters of all replies, one behind the other.
    """

    request: bytes
    length: int
    longest: int
    confusable = True
    _payload_at: Index
    _error_at: Index

    def __init__(self, spans: Sequence[Span]) -> None:
        self.spans = tuple(spans)
        self._rows = {span.id: row for row, span in enumerate(self.spans)}
        self._ends: list[int] = np.cumsum([span.size for span in self.spans]).tolist()
        self.valid: Mask = np.zeros(len(self.spans), dtype=bool)
        self.complete = False
        self.owed: Mapping[int, int] = {}
        self.doubted: frozenset[int] = frozenset()
        self.error: Bytes = np.zeros(len(self.spans), dtype=np.uint8)
        self.payload: Bytes = np.zeros(self._ends[-1], dtype=np.uint8)

    def column(self, offset: int, dtype: str, rows: slice = slice(None)) -> npt.NDArray[np.int64]:
        """Return a live view of one field of the chosen rows, which must be of equal size.

        `offset` counts bytes from the start of each span; the view is updated by `decode`.
        """
        chosen = range(len(self.spans))[rows]
        size = self.spans[chosen[0]].size
        start = self._ends[chosen[0]] - size + offset
        return np.ndarray((len(chosen),), dtype, self.payload.data, start, (size,))

    def params(self, row: int) -> bytes:
        """Return the last good parameters of one row."""
        return self.payload[self._ends[row] - self.spans[row].size : self._ends[row]].tobytes()

    def decode(self, stream: bytes) -> Mask:
        """Take in an answer and return (n,) bool: whose reply was in it and good."""
        if len(stream) == self.length and not stream.startswith(self.request):
            data = np.frombuffer(stream, dtype=np.uint8)
            if self._sound(data):
                data.take(self._payload_at, out=self.payload, mode="clip")
                data.take(self._error_at, out=self.error, mode="clip")
                if not self.complete:
                    self.valid.fill(True)
                    self.complete, self.doubted = True, frozenset()
                return self.valid
        self._salvage(stream)
        return self.valid

    @abstractmethod
    def answered(self) -> int:
        """Return how many bytes the good replies to the last request had."""

    @abstractmethod
    def _sound(self, data: Bytes) -> bool:
        """Return whether an answer of the full length is what it should be, all of it."""

    @abstractmethod
    def _statuses(self, stream: bytes) -> Iterable[Status]:
        """Return the good replies in a dirty stream."""

    def _salvage(self, stream: bytes) -> None:
        """Take in the good replies of a stream in which our own request may have come back."""
        self.valid.fill(False)
        stream = stream.replace(self.request, b"")
        found = self._told_apart(self._statuses(stream))
        self.doubted = frozenset()
        if self.owed:
            sure = newest(found, self._rows, self.owed)
            if not sure:
                self.doubted = frozenset(item.id for item in found if item.id in self._rows)
            found = sure
        for item in in_turn(found, self._rows):
            self._take(self._rows[item.id], item)
        self.complete = bool(self.valid.all())

    def _take(self, row: int, item: Status) -> None:
        end = self._ends[row]
        self.payload[end - len(item.params) : end] = np.frombuffer(item.params, np.uint8)
        self.error[row] = item.error
        self.valid[row] = True

    def _told_apart(self, items: Iterable[Status]) -> list[Status]:
        """Return the frames that are as long as was asked; others lose their id, and keep a turn.

        Where one servo was asked they are left out: they can only be somebody's late answer.
        """
        found = []
        for item in items:
            row = self._rows.get(item.id)
            if row is not None and len(item.params) == self.spans[row].size:
                found.append(item)
            elif len(self.spans) > 1:
                found.append(item._replace(id=NOBODY))
        return found


class CyclicWrite(Protocol):
    """A sync write of one register, built once and patched each time.

    Attributes:
        values: (n,) integers: assign to it, then call `frames`.
    """

    values: npt.NDArray[np.int64]

    def frames(self) -> list[bytes]:
        """Return the frames to send for the present `values`."""
        ...
