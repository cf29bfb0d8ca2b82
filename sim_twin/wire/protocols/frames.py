"""Frames of Dynamixel protocol 2, encoded and parsed as a servo does.

Written from the manual and independent of the driver's codec, so that each tests the other. A servo
is strict: it drops a frame with a wrong CRC, or with an unstuffed header inside.

Frame: ``FF FF FD 00, id, length (2), instruction, parameters..., CRC (2)``; the length counts from
the instruction to the CRC. Between instruction and CRC, ``FF FF FD`` is sent as ``FF FF FD FD``.
"""

import re
import struct
from typing import Final, NamedTuple

HEADER: Final = b"\xff\xff\xfd\x00"
BROADCAST: Final = 0xFE
STATUS: Final = 0x55
ID_AT: Final = 4
LENGTH_AT: Final = 5

LENGTH_MAX = 4096  # bytes; longer frames are treated as noise
SMALLEST = 3  # smallest length: instruction and CRC

_BARE_HEADER = re.compile(rb"\xff\xff\xfd(?!\xfd)")
_PATTERN, _STUFFED = b"\xff\xff\xfd", b"\xff\xff\xfd\xfd"


def _crc_table() -> tuple[int, ...]:
    """Return the CRCs of all byte pairs: CRC-16/BUYPASS, polynomial 0x8005, initial value 0."""
    single = []
    for byte in range(256):
        crc = byte << 8
        for _ in range(8):
            crc = (crc << 1) ^ (0x8005 if crc & 0x8000 else 0)
        single.append(crc & 0xFFFF)
    return tuple(
        (crc << 8) & 0xFF00 ^ single[crc >> 8 ^ low] for crc in single for low in range(256)
    )


_CRC = _crc_table()
_HEADS: dict[tuple[int, int], tuple[bytes, int]] = {}


def crc16(data: bytes | bytearray, crc: int = 0) -> int:
    """Return the CRC of `data`, continuing from `crc`.

    >>> hex(crc16(bytes.fromhex("FFFFFD0001030001")))
    '0x4e19'
    """
    table = _CRC
    if len(data) & 1:
        crc = (crc << 8) & 0xFF00 ^ table[crc >> 8 ^ data[0]]
        data = data[1:]
    for pair in struct.unpack(f">{len(data) // 2}H", data):
        crc = table[crc ^ pair]
    return crc


def stuff(body: bytes) -> bytes:
    """Return `body` with byte stuffing: an FD after every header pattern."""
    return body.replace(_PATTERN, _STUFFED) if _PATTERN in body else body


def encode(identifier: int, instruction: int, parameters: bytes = b"") -> bytes:
    """Return an instruction frame."""
    body = stuff(bytes((instruction,)) + parameters)
    frame = HEADER + bytes((identifier,)) + (len(body) + 2).to_bytes(2, "little") + body
    return frame + crc16(frame).to_bytes(2, "little")


def encode_status(identifier: int, error: int, parameters: bytes = b"") -> bytes:
    """Return a status packet; its head and the CRC of the head are cached."""
    body = bytes((error,)) + parameters
    if _PATTERN in body:
        return encode(identifier, STATUS, body)
    key = (identifier, len(body))
    known = _HEADS.get(key)
    if known is None:
        head = HEADER + bytes((identifier, *(len(body) + 3).to_bytes(2, "little"), STATUS))
        known = _HEADS[key] = head, crc16(head)
    return known[0] + body + crc16(body, known[1]).to_bytes(2, "little")


def with_checksum(frame: bytes) -> bytes:
    """Return `frame` with the correct CRC."""
    return frame[:-2] + crc16(frame[:-2]).to_bytes(2, "little")


class Frame(NamedTuple):
    """One valid frame.

    Attributes:
        identifier: Id that it is addressed to (instruction) or comes from (status).
        instruction: Instruction number.
        parameters: Parameters, unstuffed.
        end: Number of bytes of the latest chunk up to the end of the frame.
    """

    identifier: int
    instruction: int
    parameters: bytes
    end: int

    @property
    def noise(self) -> bool:
        """False: a valid frame is not noise."""
        return False


class FrameError(NamedTuple):
    """A sequence of bytes that was dropped.

    Attributes:
        reason: "crc", "stuffing" or "length".
        end: As in `Frame`.
        identifier: Id in the frame, where only the CRC is wrong.
    """

    reason: str
    end: int
    identifier: int = BROADCAST

    @property
    def noise(self) -> bool:
        """Whether it is not even a frame with a wrong CRC."""
        return self.reason != "crc"


class Parser:
    """Turns a stream of bytes, in chunks of any size, into frames and errors."""

    def __init__(self) -> None:
        self._pending = bytearray()

    def reset(self) -> None:
        """Discard an incomplete frame."""
        self._pending.clear()

    def feed(self, chunk: bytes) -> list[Frame | FrameError]:
        """Parse `chunk` and return the items that it completes, in order."""
        found: list[Frame | FrameError] = []
        before = len(self._pending)
        self._pending += chunk
        taken = 0
        while True:
            item, used = self._next(taken - before)
            taken += used
            del self._pending[:used]
            if item is None:
                return found
            found.append(item)

    def _next(self, offset: int) -> tuple[Frame | FrameError | None, int]:
        """Return the first complete item and the bytes used; the data starts at `offset`."""
        data = self._pending
        start = data.find(HEADER)
        if start < 0:
            return None, _useless(data)
        if len(data) < start + 7:
            return None, start
        length = data[start + 5] | data[start + 6] << 8
        if not SMALLEST <= length <= LENGTH_MAX:
            return FrameError("length", offset + start + 7), start + 4
        end = start + 7 + length
        body = bytes(data[start + 7 : end - 2])
        if bare := _BARE_HEADER.search(body):
            # Another frame may begin here: the present one is truncated or not stuffed.
            # Two bytes of the pattern are not enough; the byte after it must be known.
            known = start + 7 + bare.end()
            if len(data) > known or len(data) >= end:
                return FrameError(
                    "stuffing", offset + min(known + 1, end)
                ), start + 7 + bare.start()
        if len(data) < end:
            return None, start
        if crc16(data[start : end - 2]) != data[end - 2] | data[end - 1] << 8:
            return FrameError("crc", offset + end, data[start + 4]), start + 4
        plain = body.replace(_STUFFED, _PATTERN)
        return Frame(data[start + 4], plain[0], plain[1:], offset + end), end


def _useless(data: bytearray) -> int:
    """Return the number of leading bytes of `data` that cannot be part of a header."""
    for keep in (3, 2, 1):
        if data.endswith(HEADER[:keep]):
            return len(data) - keep
    return len(data)
