"""Vectorised cyclic codec of protocol 2: checks all replies at once, writes goals in one frame.

The layout of an answer is computed once: which bytes of the expected stream are constant, which
vary, and the distance of each from the end of its frame. Each cycle then takes a few numpy calls,
whatever the number of servos. An answer that does not fit the layout exactly (a stuffed, missing
or corrupt reply) is passed to the resynchronising parser of `windup.hal.protocols.protocol2`,
which extracts the valid replies.
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from windup.hal.protocols import protocol2
from windup.hal.protocols.crc16 import distance_table
from windup.hal.protocols.cyclic import Bytes, CyclicRead, Index
from windup.hal.protocols.protocol2 import Span, Status

FAST_HEAD = protocol2.HEADER + bytes([protocol2.BROADCAST])
"""First bytes of the answer to a fast sync read."""


class BlockRead(CyclicRead):
    """A sync read, plain or fast; if the spans differ, a bulk read.

    `length` is without byte stuffing; `longest` includes the maximum that stuffing can add.
    """

    def __init__(self, spans: Sequence[Span], fast: bool = False) -> None:
        super().__init__(spans)
        self.fast = fast
        self.echo_is_confusable = not fast  # no other answer has this format
        uniform = len({(span.address, span.size) for span in self.spans}) == 1
        ids = [span.id for span in self.spans]
        if uniform:
            first = self.spans[0]
            self.request = protocol2.sync_read(ids, first.address, first.size, fast)
        else:
            self.request = protocol2.bulk_read(self.spans)
        self._lay_out(_fast_answer(self.spans) if fast else _answers(self.spans))

    def answered_bytes(self) -> int:
        """Return the number of bytes of the valid replies to the last request, unstuffed."""
        sizes = np.array([span.size for span in self.spans])
        each = sizes + (4 if self.fast else protocol2.OVERHEAD)
        return int(each[self.valid].sum()) + (8 if self.fast else 0)

    def _sound(self, data: Bytes) -> bool:
        if data.take(self._fixed_at).tobytes() != self._fixed:
            return False
        np.add(data.take(self._vary_at), self._base, out=self._index)
        terms = self._table.take(self._index, mode="clip")
        return bool((np.bitwise_xor.reduceat(terms, self._starts) == self._fixed_crc).all())

    def _statuses(self, stream: bytes) -> Sequence[Status]:
        if self.fast:
            if stream.count(FAST_HEAD) > 1:
                return []  # the stream contains an earlier answer
            return list(protocol2.find_fast_packets(stream, self.spans[0].size, self._rows))
        return list(protocol2.find_packets(stream, self.longest))

    def _lay_out(self, answer: bytes) -> None:
        """Compute the layout from an `answer` whose error bytes, parameters and CRCs are 0."""
        self.length = len(answer)
        sizes = [span.size for span in self.spans]
        self.longest = self.length + sum((size + 1) // 3 for size in sizes)
        head = 8 if self.fast else 0
        skip, tail = (2, 2) if self.fast else (9, 2)
        starts = head + np.cumsum([0, *[skip + size + tail for size in sizes[:-1]]])
        where = list(zip(starts.tolist(), sizes, strict=True))
        params = [np.arange(at + skip, at + skip + size) for at, size in where]
        self._payload_at: Index = np.concatenate(params)
        self._error_at: Index = starts if self.fast else starts + 8
        # The varying bytes of a frame are those from the error byte to the CRC.
        first = self._error_at
        last = [at + skip + size + tail for at, size in where]
        varies = np.zeros(self.length, dtype=bool)
        for begin, end in zip(first.tolist(), last, strict=True):
            varies[begin:end] = True
        if self.fast:
            varies[starts + 1] = False
            frames = [(0, self.length)]
        else:
            frames = [(at, end) for (at, _), end in zip(where, last, strict=True)]
        self._vary_at: Index = np.flatnonzero(varies)
        self._fixed_at: Index = np.flatnonzero(~varies)
        self._fixed = bytes(answer[at] for at in self._fixed_at)
        self._checks(answer, frames)

    def _checks(self, answer: bytes, frames: list[tuple[int, int]]) -> None:
        """Prepare the tables with which the terms of each valid frame XOR to 0."""
        longest = max(end - start for start, end in frames) - 2
        table = distance_table(longest)
        plain = np.stack([np.arange(256), np.arange(256) << 8]).astype(np.uint16)
        self._table = np.concatenate([table, plain]).ravel()
        row = np.empty(self.length, dtype=np.intp)
        for start, end in frames:
            row[start : end - 2] = np.arange(end - start - 3, -1, -1)
            row[end - 2 : end] = longest, longest + 1
        base = row * 256
        self._base = base[self._vary_at]
        self._index = np.empty_like(self._base)
        heads = [start for start, _ in frames]
        self._starts: Index = np.searchsorted(self._vary_at, heads)
        constant = np.frombuffer(answer, np.uint8)[self._fixed_at] + base[self._fixed_at]
        fixed_starts = np.searchsorted(self._fixed_at, heads)
        self._fixed_crc = np.bitwise_xor.reduceat(self._table[constant], fixed_starts)


class BlockWrite:
    """A sync write of one register to n servos; the frame is built once, then only patched.

    Attributes:
        values: (n,) integers, a view into the frame: assign to it, then call `frame`.
    """

    def __init__(self, ids: Sequence[int], address: int, size: int) -> None:
        self.ids, self.address, self.size = tuple(ids), address, size
        zero = bytes(size)
        self._frame = bytearray(protocol2.sync_write(dict.fromkeys(ids, zero), address, size))
        self.values: npt.NDArray[np.int64] = np.ndarray(
            (len(self.ids),), f"<i{size}", self._frame, 13, (size + 1,)
        )
        whole = np.frombuffer(self._frame, np.uint8)
        at = np.arange(12, len(self._frame) - 2).reshape(len(self.ids), size + 1)[:, 1:].ravel()
        table = distance_table(len(self._frame) - 2)
        self._table = table.ravel()
        self._data = whole[12:-2]
        self._at: Index = at - 12
        self._base = (len(self._frame) - 3 - at) * 256
        self._index = np.empty_like(self._base)
        self._empty_crc = int.from_bytes(self._frame[-2:], "little")

    def frame(self) -> bytes:
        """Return the frame for the present `values`, with byte stuffing if needed."""
        frame = self._frame
        if frame.find(b"\xff\xff\xfd", 7, len(frame) - 2) >= 0:
            return self._stuffed()
        np.add(self._data.take(self._at), self._base, out=self._index)
        terms = self._table.take(self._index, mode="clip")
        crc = int(np.bitwise_xor.reduce(terms)) ^ self._empty_crc
        frame[-2:] = crc.to_bytes(2, "little")
        return bytes(frame)

    def frames(self) -> list[bytes]:
        """Return the list of frames to send, which has one element."""
        return [self.frame()]

    def _stuffed(self) -> bytes:
        rows = self.values.tolist()
        data = {
            id: value.to_bytes(self.size, "little", signed=True)
            for id, value in zip(self.ids, rows, strict=True)
        }
        return protocol2.sync_write(data, self.address, self.size)


def _answers(spans: Sequence[Span]) -> bytes:
    """Return the replies to a sync or bulk read, with error, parameters and CRC 0."""
    frames = []
    for span in spans:
        length = (span.size + 4).to_bytes(2, "little")
        head = protocol2.HEADER + bytes([span.id]) + length + bytes([protocol2.Instruction.STATUS])
        frames.append(head + bytes(span.size + 3))
    return b"".join(frames)


def _fast_answer(spans: Sequence[Span]) -> bytes:
    """Return the single reply to a fast sync read, with error, parameters and CRCs 0."""
    blocks = b"".join(bytes([0, span.id]) + bytes(span.size + 2) for span in spans)
    length = (len(blocks) + 1).to_bytes(2, "little")
    head = protocol2.HEADER + bytes([protocol2.BROADCAST]) + length
    return head + bytes([protocol2.Instruction.STATUS]) + blocks
