"""Frames of protocol 1, as Dynamixel AX and MX and Feetech servos read and write them.

Frame: ``FF FF, id, length, instruction, parameters..., checksum``; the length counts from the
instruction to the checksum, which is the complement of the sum from the id on. A status packet has
the error byte in place of the instruction. There is no byte stuffing: a truncated frame consumes
the beginning of the next one, and the checksum accepts one in 256 of such accidents.
"""

from typing import Final, NamedTuple

HEADER: Final = b"\xff\xff"
BROADCAST: Final = 0xFE
SMALLEST: Final = 2  # smallest length: instruction and checksum
STATUS_BYTES: Final = 6  # bytes of a status packet without its data
ID_AT: Final = 2
LENGTH_AT: Final = 3
MOST: Final = 253  # largest number of parameters; the length byte counts two more


def checksum(data: bytes | bytearray) -> int:
    """Return the checksum of the bytes between header and checksum.

    >>> hex(checksum(bytes.fromhex("0101") + bytes([2])))
    '0xfb'
    """
    return ~sum(data) & 0xFF


def encode(identifier: int, instruction: int, parameters: bytes = b"") -> bytes:
    """Return an instruction frame, or a status packet if `instruction` is an error byte.

    Parameters that exceed the length byte are omitted: a servo that is asked for 254 bytes
    answers without data.

    >>> encode(1, 1).hex(" ")
    'ff ff 01 02 01 fb'
    """
    if len(parameters) > MOST:
        parameters = b""
    body = bytes((identifier, len(parameters) + 2, instruction)) + parameters
    return HEADER + body + bytes((~sum(body) & 0xFF,))


def with_checksum(frame: bytes) -> bytes:
    """Return `frame` with the correct checksum."""
    return frame[:-1] + bytes((checksum(frame[2:-1]),))


class Frame1(NamedTuple):
    """One valid frame.

    Attributes:
        identifier: Id that it is addressed to.
        instruction: Instruction number.
        parameters: Parameters.
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


class Frame1Error(NamedTuple):
    """A sequence of bytes that was dropped.

    Attributes:
        reason: "checksum" or "length".
        identifier: Id that the bytes seem to address.
        end: As in `Frame1`.
    """

    reason: str
    identifier: int
    end: int

    @property
    def noise(self) -> bool:
        """Whether it is not even a frame with a wrong checksum."""
        return self.reason != "checksum"


class Parser1:
    """Turns a stream of bytes, in chunks of any size, into frames and errors.

    Args:
        longest: Length of the longest frame that fits into the servos' buffers, bytes.
    """

    def __init__(self, longest: int = 259) -> None:
        self.longest = longest
        self._pending = bytearray()

    def reset(self) -> None:
        """Discard an incomplete frame."""
        self._pending.clear()

    def feed(self, chunk: bytes) -> list[Frame1 | Frame1Error]:
        """Parse `chunk` and return the items that it completes, in order."""
        found: list[Frame1 | Frame1Error] = []
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

    def _next(self, offset: int) -> tuple[Frame1 | Frame1Error | None, int]:
        """Return the first complete item and the bytes used; the data starts at `offset`."""
        data = self._pending
        start = data.find(HEADER)
        if start < 0:
            return None, len(data) - 1 if data.endswith(b"\xff") else len(data)
        while data[start + 2 : start + 3] == b"\xff":  # 0xFF is no id: the header starts later
            start += 1
        if len(data) < start + 4:
            return None, start
        identifier, length = data[start + ID_AT], data[start + LENGTH_AT]
        end = start + 4 + length
        if length < SMALLEST or end - start > self.longest:
            return Frame1Error("length", identifier, offset + start + 4), start + 2
        if len(data) < end:
            return None, start
        if checksum(data[start + 2 : end - 1]) != data[end - 1]:
            return Frame1Error("checksum", identifier, offset + end), start + 2
        parameters = bytes(data[start + 5 : end - 1])
        return Frame1(identifier, data[start + 4], parameters, offset + end), end
