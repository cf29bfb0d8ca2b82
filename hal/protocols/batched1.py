"""The cyclic codec of protocol 1: all checksums of a cycle at once, all goals in one frame.

In the manner of `hal.protocols.batched`. A whole frame, header and checksum included, sums to
0xFD modulo 256, so one `add.reduceat` over bytes checks every reply.
"""

from collections import Counter
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hal.protocols import protocol1
from hal.protocols.cyclic import Bytes, CyclicRead, Index
from hal.protocols.protocol2 import Span, Status
from hal.registers import Register

FRAME_SUM = 0xFD
"""Sum of the bytes of any whole frame, modulo 256."""
_ID, _ERROR, _PARAMS = 2, 4, 5
"""Places in a status frame."""


class StatusRead(CyclicRead):
    """One request that several servos, or one, answer with frames of protocol 1."""

    def __init__(self, spans: Sequence[Span], request: bytes) -> None:
        super().__init__(spans)
        self.request = request
        self._sizes = {span.id: span.size for span in self.spans}
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

    def answered(self) -> int:
        """Return how many bytes the good replies to the last request had."""
        return int(self._widths[self.valid].sum())

    def _sound(self, data: Bytes) -> bool:
        if data.take(self._heads).tobytes() != self._head:
            return False
        sums = np.add.reduceat(data, self._starts, dtype=np.uint8)
        return bool((sums == FRAME_SUM).all())

    def _statuses(self, stream: bytes) -> list[Status]:
        """Return the good replies of those who were asked; two under one id are none.

        A servo answers once. If two frames bear one id, a wrong id has passed the checksum, or
        two servos have it: nobody knows which to believe.
        """
        found = list(protocol1.salvage(stream, self._sizes))
        often = Counter(item.id for item in found)
        return [item for item in found if often[item.id] == 1]


class ChainRead(CyclicRead):
    """Reads of one servo each, the next asked as soon as the one before has answered.

    What is left where servos know no common read (AX-12, SCS), or where a servo is missing and
    those behind it would wait for it.

    Attributes:
        parts: The reads, in the order of `spans`.
    """

    def __init__(self, spans: Sequence[Span]) -> None:
        super().__init__(spans)
        self.parts = tuple(StatusRead([span], protocol1.read(*span)) for span in self.spans)
        self.request = self.parts[0].request
        self.length = self.longest = sum(part.length for part in self.parts)

    def begin(self) -> None:
        """Forget who has answered."""
        self.valid.fill(False)
        self.complete = False

    def collected(self, row: int) -> None:
        """Take over what the part at `row` has got."""
        part = self.parts[row]
        if part.complete:
            self._take(row, Status(part.spans[0].id, int(part.error[0]), part.payload.tobytes()))
        self.complete = bool(self.valid.all())

    def answered(self) -> int:
        """Return how many bytes the good replies to the last request had."""
        return sum(part.answered() for part in self.parts)

    def _sound(self, data: Bytes) -> bool:
        """Only parts are decoded at full length."""
        return False

    def _statuses(self, stream: bytes) -> list[Status]:
        sizes = {span.id: span.size for span in self.spans}
        return list(protocol1.salvage(stream, sizes))


def sync_read(spans: Sequence[Span]) -> StatusRead:
    """Return Feetech's sync read; the spans must be alike but for the id."""
    first = spans[0]
    request = protocol1.sync_read([span.id for span in spans], first.address, first.size)
    return StatusRead(spans, request)


def bulk_read(spans: Sequence[Span]) -> StatusRead:
    """Return Dynamixel's bulk read."""
    return StatusRead(spans, protocol1.bulk_read(spans))


class GoalWrite:
    """Sync writes of one register to n servos, built once and patched each time.

    Attributes:
        values: (n,) integers as the register spells them: assign, then call `frames`.
    """

    def __init__(self, ids: Sequence[int], register: Register, longest: int) -> None:
        self.ids, self.register = tuple(ids), register
        zero = dict.fromkeys(ids, bytes(register.size))
        self._raw = protocol1.split_sync_write(zero, register.address, register.size, longest)
        self._data: Bytes = np.frombuffer(bytearray(b"".join(self._raw)), np.uint8)
        ends = np.cumsum([len(raw) for raw in self._raw])
        self._cuts = list(zip([0, *ends[:-1].tolist()], ends.tolist(), strict=True))
        self._checks = (ends - 1).tolist()
        self.values: npt.NDArray[np.int64] = np.zeros(len(self.ids), dtype=np.int64)
        row = 0
        self._views = []
        for start, end in self._cuts:
            count = (end - start - 8) // (register.size + 1)
            view: npt.NDArray[np.int64] = np.ndarray(
                (count,), register.dtype, self._data.data, start + 8, (register.size + 1,)
            )
            self._views.append((view, slice(row, row + count)))
            row += count

    def frames(self) -> list[bytes]:
        """Return the frames for the present `values`."""
        data, register = self._data, self.register
        values = self.values
        if register.sign_bit is not None:
            values = np.where(values < 0, -values | 1 << register.sign_bit, values)
        frames = []
        for (view, rows), (start, end), check in zip(
            self._views, self._cuts, self._checks, strict=True
        ):
            view[...] = values[rows]
            data[check] = 0
            data[check] = FRAME_SUM - int(data[start:check].sum()) & 0xFF
            frames.append(data[start:end].tobytes())
        return frames
