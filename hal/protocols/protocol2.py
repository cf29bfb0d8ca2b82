"""Dynamixel protocol 2: encodes instruction frames, and finds status packets in a stream.

A frame, with the checksum over everything before it::

    FF FF FD 00 | id | length (2) | instruction | parameters ... | CRC (2)

`length` counts from the instruction to the end. A status packet has instruction 0x55 and an error
byte before its parameters. Inside instruction and parameters every FF FF FD is followed by one
more FD (byte stuffing), so that no payload looks like a header. All numbers are little-endian.
"""

from collections.abc import Iterable, Iterator, Mapping
from enum import IntEnum
from typing import NamedTuple

from windup.hal.protocols.crc16 import crc16

HEADER = b"\xff\xff\xfd\x00"
BROADCAST = 0xFE
LAST_ID = 0xFC
OVERHEAD = 11
"""Length of a status packet without parameters, bytes."""
LONGEST = 1024
"""Maximum length of a frame from a servo, bytes; a larger length field is noise."""
ALERT = 0x80
"""Bit of the error byte: the servo's hardware error register is not 0."""

_PATTERN = b"\xff\xff\xfd"
_STUFFED = b"\xff\xff\xfd\xfd"


class Instruction(IntEnum):
    """Instruction bytes."""

    PING = 0x01
    READ = 0x02
    WRITE = 0x03
    REG_WRITE = 0x04
    ACTION = 0x05
    FACTORY_RESET = 0x06
    REBOOT = 0x08
    CLEAR = 0x10
    STATUS = 0x55
    SYNC_READ = 0x82
    SYNC_WRITE = 0x83
    FAST_SYNC_READ = 0x8A
    BULK_READ = 0x92
    BULK_WRITE = 0x93


class Status(NamedTuple):
    """One status packet: id, error byte, and the unstuffed parameters."""

    id: int
    error: int
    params: bytes


class Span(NamedTuple):
    """A range of consecutive registers of one servo; `size` is in bytes."""

    id: int
    address: int
    size: int


def stuff(payload: bytes) -> bytes:
    """Return `payload` with an FD inserted after every FF FF FD."""
    return payload.replace(_PATTERN, _STUFFED)


def unstuff(payload: bytes) -> bytes:
    """Return `payload` without the bytes that `stuff` inserts."""
    return payload.replace(_STUFFED, _PATTERN)


def frame(id: int, instruction: int, params: bytes = b"") -> bytes:
    """Return a complete frame, stuffed and with its CRC.

    >>> frame(1, Instruction.PING).hex(" ")
    'ff ff fd 00 01 03 00 01 19 4e'
    """
    body = stuff(bytes([instruction]) + params)
    head = HEADER + bytes([id]) + (len(body) + 2).to_bytes(2, "little")
    return head + body + crc16(head + body).to_bytes(2, "little")


def status(id: int, params: bytes = b"", error: int = 0) -> bytes:
    """Return a status packet of servo `id`."""
    return frame(id, Instruction.STATUS, bytes([error]) + params)


def ping(id: int = BROADCAST) -> bytes:
    """Return the frame that pings one servo, or all with a broadcast."""
    return frame(id, Instruction.PING)


def read(id: int, address: int, size: int) -> bytes:
    """Return the frame that reads `size` bytes at `address`."""
    return frame(id, Instruction.READ, _range(address, size))


def write(id: int, address: int, data: bytes) -> bytes:
    """Return the frame that writes `data` at `address`."""
    return frame(id, Instruction.WRITE, _word(address) + data)


def reg_write(id: int, address: int, data: bytes) -> bytes:
    """Return the frame that stores a write until `action`."""
    return frame(id, Instruction.REG_WRITE, _word(address) + data)


def action(id: int = BROADCAST) -> bytes:
    """Return the frame that executes stored writes."""
    return frame(id, Instruction.ACTION)


def reboot(id: int) -> bytes:
    """Return the frame that reboots a servo."""
    return frame(id, Instruction.REBOOT)


def factory_reset(id: int, keep: int = 0x02) -> bytes:
    """Return the reset frame; `keep`: 0xFF keeps nothing, 0x01 the id, 0x02 id and baud rate."""
    return frame(id, Instruction.FACTORY_RESET, bytes([keep]))


def sync_read(ids: Iterable[int], address: int, size: int, fast: bool = False) -> bytes:
    """Return the frame that reads the same registers of several servos."""
    kind = Instruction.FAST_SYNC_READ if fast else Instruction.SYNC_READ
    return frame(BROADCAST, kind, _range(address, size) + bytes(ids))


def sync_write(data: Mapping[int, bytes], address: int, size: int) -> bytes:
    """Return the frame that writes `size` bytes at `address` of each id in `data`."""
    body = b"".join(bytes([id]) + value for id, value in data.items())
    return frame(BROADCAST, Instruction.SYNC_WRITE, _range(address, size) + body)


def bulk_read(spans: Iterable[Span]) -> bytes:
    """Return the bulk read frame: different registers per servo. Ids must be unique."""
    body = b"".join(bytes([span.id]) + _range(span.address, span.size) for span in spans)
    return frame(BROADCAST, Instruction.BULK_READ, body)


def find_packets(stream: bytes, longest: int = LONGEST) -> Iterator[Status]:
    """Yield every valid status packet in `stream`, whatever bytes lie between them.

    Never raises. After an impossible length, a truncated frame or a wrong CRC the search continues
    after that header, so a corrupt length does not skip valid packets.
    """
    at = stream.find(HEADER)
    while at >= 0:
        end = at + 7 + int.from_bytes(stream[at + 5 : at + 7], "little")
        if _is_status(stream, at, end, longest):
            yield Status(stream[at + 4], stream[at + 8], unstuff(stream[at + 9 : end - 2]))
            at = stream.find(HEADER, end)
        else:
            at = stream.find(HEADER, at + len(HEADER))


def _is_status(stream: bytes, at: int, end: int, longest: int) -> bool:
    return (
        at + OVERHEAD <= end <= min(len(stream), at + longest)
        and stream[at + 7] == Instruction.STATUS
        and stream[at + 4] <= LAST_ID
        and crc16(stream[at : end - 2]) == int.from_bytes(stream[end - 2 : end], "little")
    )


def find_fast_packets(stream: bytes, size: int, ids: Iterable[int]) -> Iterator[Status]:
    """Yield the valid blocks of an answer to a fast sync read of `size` bytes per servo.

    All servos answer in one frame without stuffing; each block ends with the CRC of the frame so
    far. Each CRC is computed from the one that the previous block sent, so that one corrupt block
    loses only one servo. A block whose id is not the next of `ids` is rejected.
    """
    width = size + 4
    at = stream.find(HEADER + bytes([BROADCAST]))
    if at < 0 or stream[at + 7 : at + 8] != bytes([Instruction.STATUS]):
        return
    crc = crc16(stream[at : at + 8])
    for start, id in zip(range(at + 8, len(stream) - width + 1, width), ids, strict=False):
        block = stream[start : start + width]
        sent = int.from_bytes(block[-2:], "little")
        if crc16(block[:-2], crc) == sent and block[1] == id:
            yield Status(block[1], block[0], block[2:-2])
        crc = crc16(block[-2:], sent)


def _word(value: int) -> bytes:
    return value.to_bytes(2, "little")


def _range(address: int, size: int) -> bytes:
    return _word(address) + _word(size)
