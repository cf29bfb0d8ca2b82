"""Vectorised cyclic codec of protocol 1: checks all replies at once, writes goals in one frame.

It works like `windup.hal.protocols.batched`. The bytes of a whole frame, header and checksum
included, sum to 0xFD modulo 256, so one `add.reduceat` over the bytes checks every reply.
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from windup.hal.protocols import protocol1
from windup.hal.protocols.cyclic import Bytes, CyclicRead, Index
from windup.hal.protocols.protocol2 import Span, Status
from windup.hal.registers import Register

FRAME_SUM = 0xFD
"""Sum of the bytes of any valid frame, modulo 256."""
_ID, _ERROR, _PARAMS = 2, 4, 5
"""Byte offsets in a status packet."""
_FIRST = 8
"""Byte offset of the first value in a sync write."""


class StatusRead(CyclicRead):
    """One request that one or several servos answer with status packets of protocol 1."""

    def __init__(self, spans: Sequence[Span], request: bytes) -> None:
        super().__init__(spans)
        self.request = request
        self._sizes = {span.id: span.size for span in self.spans}
        # If one servo was asked, a reply with another id can only be a late answer.
        self._others = frozenset(self._sizes.values()) if len(self.spans) > 1 else frozenset()
        sizes = np.array([span.size for span in self.spans])
        self._widths = sizes + protocol1.OVERHEAD
        self.length = self.longest = int(self._widths.sum())
        self._starts: Index = np.cumsum(self._widths) - self._widths
        self._error_at = self._starts + _ERROR
        where = zip(self._starts.tolist(), sizes.tolist(), strict=True)
        self._payload_at = np.concatenate(
            [np.arange(at + _PARAMS, at + _PARAMS + size) for at, size in where]
        )
        self._heads: Index = (self._starts[:, None] + np.arange(_ERROR)).ravel()
        self._head = b"".join(
            protocol1.status(span.id, bytes(span.size))[:_ERROR] for span in self.spans
        )

    def answered_bytes(self) -> int:
        """Return the number of bytes of the valid replies to the last request."""
        return int(self._widths[self.valid].sum())

    def _sound(self, data: Bytes) -> bool:
        if data.take(self._heads).tobytes() != self._head:
            return False
        sums = np.add.reduceat(data, self._starts, dtype=np.uint8)
        return bool((sums == FRAME_SUM).all())

    def _statuses(self, stream: bytes) -> list[Status]:
        return list(protocol1.find_packets(stream, self._sizes, self._others))


class ChainRead(CyclicRead):
    """Single reads of one servo each; each is requested when the one before has been answered.

    Used for servos that support no sync or bulk read (AX-12, SCS), and if a servo is missing, for
    whose reply the later ones would wait.

    Attributes:
        parts: The single reads, in the order of `spans`.
    """

    def __init__(self, spans: Sequence[Span]) -> None:
        super().__init__(spans)
        self.parts = tuple(StatusRead([span], protocol1.read(*span)) for span in self.spans)
        self.request = self.parts[0].request
        self.length = self.longest = sum(part.length for part in self.parts)

    def begin(self) -> None:
        """Mark all replies as missing, before a new cycle."""
        self.valid.fill(False)
        self.complete = False

    def collected(self, row: int) -> None:
        """Copy the reply of the part at `row`, if it is complete."""
        part = self.parts[row]
        if part.complete:
            self._take(row, Status(part.spans[0].id, int(part.error[0]), part.payload.tobytes()))
        self.complete = bool(self.valid.all())

    def answered_bytes(self) -> int:
        """Return the number of bytes of the valid replies to the last request."""
        return sum(part.answered_bytes() for part in self.parts)

    def _sound(self, data: Bytes) -> bool:
        """Return False: only the parts are decoded by layout."""
        return False

    def _statuses(self, stream: bytes) -> list[Status]:
        sizes = {span.id: span.size for span in self.spans}
        return list(protocol1.find_packets(stream, sizes))


def sync_read(spans: Sequence[Span]) -> StatusRead:
    """Return Feetech's sync read; all spans must have the same address and size."""
    first = spans[0]
    request = protocol1.sync_read([span.id for span in spans], first.address, first.size)
    return StatusRead(spans, request)


def bulk_read(spans: Sequence[Span]) -> StatusRead:
    """Return Dynamixel's bulk read."""
    return StatusRead(spans, protocol1.bulk_read(spans))


class GoalWrite:
    """Sync writes of one register to n servos; the frames are built once, then only patched.

    Attributes:
        values: (n,) values of the register, counts: assign to it, then call `frames`.
    """

    def __init__(self, ids: Sequence[int], register: Register, longest: int) -> None:
        self.ids, self.register = tuple(ids), register
        self.values: npt.NDArray[np.int64] = np.zeros(len(self.ids), dtype=np.int64)
        zero = dict.fromkeys(ids, bytes(register.size))
        frames = protocol1.split_sync_write(zero, register.address, register.size, longest)
        self._parts: list[tuple[bytearray, npt.NDArray[np.int64], slice]] = []
        row = 0
        for raw in frames:
            frame, width = bytearray(raw), register.size + 1
            count = (len(frame) - _FIRST) // width
            view: npt.NDArray[np.int64] = np.ndarray(
                (count,), register.dtype, frame, _FIRST, (width,)
            )
            self._parts.append((frame, view, slice(row, row + count)))
            row += count

    def frames(self) -> list[bytes]:
        """Return the frames for the present `values`."""
        values, bit = self.values, self.register.sign_bit
        if bit is not None and values.min() < 0:
            values = np.where(values < 0, -values | 1 << bit, values)
        for frame, view, rows in self._parts:
            view[...] = values[rows]
            frame[-1] = ~sum(frame[2:-1]) & 0xFF
        return [bytes(frame) for frame, _, _ in self._parts]
