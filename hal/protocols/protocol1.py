"""Protocol 1 of Dynamixel and Feetech: encodes frames, and finds status packets in a stream.

A frame, with a checksum that makes its bytes from the id on sum to 255::

    FF FF | id | length | instruction | parameters ... | checksum

`length` counts from the instruction to the end. A status packet has an error byte in the place of
the instruction. There is no byte stuffing, so FF FF may occur inside a frame, and one corrupt frame
in 256 has a valid checksum: callers should pass the expected ids and sizes (`sizes`).
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from enum import IntEnum

from windup.hal.protocols.protocol2 import Span, Status

HEADER = b"\xff\xff"
BROADCAST = 0xFE
LAST_ID = 0xFD
OVERHEAD = 6
"""Length of a status packet without parameters, bytes."""
LONGEST_FEETECH = 250
"""Maximum length of a frame that feetech-servo-sdk sends, bytes."""
LONGEST_DYNAMIXEL = 143
"""Size of the receive buffer of an AX-12, bytes."""


class Instruction(IntEnum):
    """Instruction bytes."""

    PING = 0x01
    READ = 0x02
    WRITE = 0x03
    REG_WRITE = 0x04
    ACTION = 0x05
    FACTORY_RESET = 0x06
    """Called "recovery" by Feetech."""
    RESET_TURNS = 0x0A
    """Feetech only: resets the multi-turn count."""
    SYNC_READ = 0x82
    """Feetech only."""
    SYNC_WRITE = 0x83
    BULK_READ = 0x92
    """Dynamixel MX only."""


def frame(id: int, instruction: int, params: bytes = b"") -> bytes:
    """Return a complete frame; for a status packet, `instruction` is the error byte.

    >>> frame(1, Instruction.PING).hex(" ")
    'ff ff 01 02 01 fb'
    """
    body = bytes([id, len(params) + 2, instruction]) + params
    return HEADER + body + bytes([~sum(body) & 0xFF])


def status(id: int, params: bytes = b"", error: int = 0) -> bytes:
    """Return a status packet of servo `id`."""
    return frame(id, error, params)


def ping(id: int) -> bytes:
    """Return the frame that pings one servo."""
    return frame(id, Instruction.PING)


def read(id: int, address: int, size: int) -> bytes:
    """Return the frame that reads `size` bytes at `address`."""
    return frame(id, Instruction.READ, bytes([address, size]))


def write(id: int, address: int, data: bytes) -> bytes:
    """Return the frame that writes `data` at `address`."""
    return frame(id, Instruction.WRITE, bytes([address]) + data)


def reg_write(id: int, address: int, data: bytes) -> bytes:
    """Return the frame that stores a write until `action`."""
    return frame(id, Instruction.REG_WRITE, bytes([address]) + data)


def action(id: int = BROADCAST) -> bytes:
    """Return the frame that executes stored writes."""
    return frame(id, Instruction.ACTION)


def factory_reset(id: int) -> bytes:
    """Return the frame that resets all registers to the factory defaults (Feetech: recovery)."""
    return frame(id, Instruction.FACTORY_RESET)


def reset_turns(id: int) -> bytes:
    """Return Feetech's frame that resets the multi-turn count of a servo."""
    return frame(id, Instruction.RESET_TURNS)


def sync_read(ids: Iterable[int], address: int, size: int) -> bytes:
    """Return Feetech's frame that reads the same registers of several servos."""
    return frame(BROADCAST, Instruction.SYNC_READ, bytes([address, size, *ids]))


def sync_write(data: Mapping[int, bytes], address: int, size: int) -> bytes:
    """Return the frame that writes `size` bytes at `address` of each id in `data`."""
    body = b"".join(bytes([id]) + value for id, value in data.items())
    return frame(BROADCAST, Instruction.SYNC_WRITE, bytes([address, size]) + body)


def split_sync_write(
    data: Mapping[int, bytes], address: int, size: int, longest: int
) -> list[bytes]:
    """Return sync writes for `data`, split so that each has at most `longest` bytes."""
    items = list(data.items())
    each = (longest - OVERHEAD - 2) // (size + 1)
    return [
        sync_write(dict(items[at : at + each]), address, size) for at in range(0, len(items), each)
    ]


def bulk_read(spans: Iterable[Span]) -> bytes:
    """Return Dynamixel's bulk read: different registers per servo. Ids must be unique."""
    body = b"".join(bytes([span.size, span.id, span.address]) for span in spans)
    return frame(BROADCAST, Instruction.BULK_READ, b"\x00" + body)


def find_packets(
    stream: bytes, sizes: Mapping[int, int] | None = None, others: Collection[int] = ()
) -> Iterator[Status]:
    """Yield every valid status packet in `stream`, whatever bytes lie between them.

    Never raises. After bytes that are not a valid packet the search continues one byte after their
    header, so a corrupt length does not skip valid packets.

    Args:
        stream: The bytes.
        sizes: Maps id to the number of parameter bytes requested; packets that differ are not
            accepted. By default every id and length is accepted.
        others: Numbers of parameter bytes that are accepted with any other id.
    """
    at = stream.find(HEADER)
    while 0 <= at <= len(stream) - OVERHEAD:
        id, length = stream[at + 2], stream[at + 3]
        end = at + 4 + length
        if sizes is None:
            expected = length >= 2
        else:
            expected = length - 2 == sizes[id] if id in sizes else length - 2 in others
        if expected and id <= LAST_ID and end <= len(stream) and _sums_up(stream[at + 2 : end]):
            yield Status(id, stream[at + 4], stream[at + 5 : end - 1])
            at = stream.find(HEADER, end)
        else:
            at = stream.find(HEADER, at + 1)


def _sums_up(body: bytes) -> bool:
    return sum(body) & 0xFF == 0xFF
