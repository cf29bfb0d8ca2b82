"""Base class of cyclic reads: one request, n replies, and the last valid bytes of each."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from typing import Protocol

import numpy as np
import numpy.typing as npt

from windup.hal.joints import Mask
from windup.hal.protocols.protocol2 import Span, Status
from windup.hal.protocols.reply_order import current_replies, in_order

NO_SERVO = -1
"""Id given to a reply that does not match any requested span."""

Bytes = npt.NDArray[np.uint8]
Index = npt.NDArray[np.intp]


class CyclicRead(ABC):
    """One request and the n replies to it.

    An answer that fits the expected layout exactly is checked in one step; any other is passed to
    the resynchronising parser of the protocol, which extracts the valid replies.

    Attributes:
        spans: The registers to read of each servo, in the order of the replies.
        request: The frame to send.
        length: Length of a complete answer, bytes.
        longest: Maximum length of an answer, bytes.
        valid: (n,) bool: servos that answered the last request.
        complete: Whether all servos answered the last request.
        owed: Maps id to the number of earlier requests that it may still answer; set by
            `BusTransactions`.
        doubted: Ids whose replies may belong to an earlier request.
        echo_is_confusable: Whether a late answer could be taken for the answer to another request.
        error: (n,) error bytes of each servo's last valid reply.
        payload: Parameters of each servo's last valid reply, concatenated.
    """

    request: bytes
    length: int
    longest: int
    echo_is_confusable = True
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
        """Return a live view of one field of the chosen rows, whose spans must have equal size.

        `offset` counts bytes from the start of each span; the view is updated by `decode`.
        """
        chosen = range(len(self.spans))[rows]
        size = self.spans[chosen[0]].size
        start = self._ends[chosen[0]] - size + offset
        return np.ndarray((len(chosen),), dtype, self.payload.data, start, (size,))

    def params(self, row: int) -> bytes:
        """Return the parameters of the last valid reply of one row."""
        return self.payload[self._ends[row] - self.spans[row].size : self._ends[row]].tobytes()

    def decode(self, stream: bytes) -> Mask:
        """Decode an answer and return (n,) bool: servos with a valid reply in it."""
        if len(stream) == self.length and not stream.startswith(self.request):
            data = np.frombuffer(stream, dtype=np.uint8)
            if self._sound(data):
                data.take(self._payload_at, out=self.payload, mode="clip")
                data.take(self._error_at, out=self.error, mode="clip")
                if not self.complete:
                    self.valid.fill(True)
                    self.complete, self.doubted = True, frozenset()
                return self.valid
        self._decode_found(stream)
        return self.valid

    @abstractmethod
    def answered_bytes(self) -> int:
        """Return the number of bytes of the valid replies to the last request."""

    @abstractmethod
    def _sound(self, data: Bytes) -> bool:
        """Return whether an answer of length `length` fits the layout and its checksums."""

    @abstractmethod
    def _statuses(self, stream: bytes) -> Iterable[Status]:
        """Return the valid replies in a stream that may contain other bytes."""

    def _decode_found(self, stream: bytes) -> None:
        """Decode the valid replies of a stream that may contain an echo of the request."""
        self.valid.fill(False)
        stream = stream.replace(self.request, b"")
        found = self._told_apart(self._statuses(stream))
        self.doubted = frozenset()
        if self.owed:
            sure = current_replies(found, self._rows, self.owed)
            if not sure:
                self.doubted = frozenset(item.id for item in found if item.id in self._rows)
            found = sure
        for item in in_order(found, self._rows):
            self._take(self._rows[item.id], item)
        self.complete = bool(self.valid.all())

    def _take(self, row: int, item: Status) -> None:
        end = self._ends[row]
        self.payload[end - len(item.params) : end] = np.frombuffer(item.params, np.uint8)
        self.error[row] = item.error
        self.valid[row] = True

    def _told_apart(self, items: Iterable[Status]) -> list[Status]:
        """Return the replies; one with an unexpected id or length gets the id `NO_SERVO`.

        If only one servo was asked, such replies are dropped: they can only be late answers.
        """
        found = []
        for item in items:
            row = self._rows.get(item.id)
            if row is not None and len(item.params) == self.spans[row].size:
                found.append(item)
            elif len(self.spans) > 1:
                found.append(item._replace(id=NO_SERVO))
        return found


class CyclicWrite(Protocol):
    """A sync write of one register; the frames are built once, then only patched.

    Attributes:
        values: (n,) integers: assign to it, then call `frames`.
    """

    values: npt.NDArray[np.int64]

    def frames(self) -> list[bytes]:
        """Return the frames to send for the present `values`."""
        ...
