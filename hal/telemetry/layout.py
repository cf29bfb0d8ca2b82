"""Layout of the file of a telemetry ring: a head of fixed size, and where the rest of it is.

After the head come the header as JSON, the records of the last ticks, the names of the last runs,
and the last marks. The record of tick s is number s modulo `records`, that of run r is number r
modulo `name_slots`, and that of mark m number m modulo `mark_slots`. All numbers are little-endian.
The first two fields of the head are the same in every version.

A record is written in this order: its sequence number becomes 0, its bytes are copied, its sequence
number becomes that of the tick, and then `sequence` of the head does. A reader copies a record and
takes it if its sequence number is that of the tick before and after, and its checksum is right:
the checksum covers computers on which the order of writes is not that of reads.
"""

import struct
import zlib
from typing import Final

import numpy as np

MAGIC: Final = b"WINDUPTR"
VERSION: Final = 3
ALIGNMENT: Final = 64
RUNS, OVER, CLOSED = 0, 1, 2
"""Values of `phase` in the head: a run goes on; it has ended; the session was closed as well."""

TABLE: Final = """
magic         S8    WINDUPTR
version       <u4   version of the format
json_size     <u4   size of the header, bytes
sequence      <u8   number of the newest tick, from 1; 0 before any
runs          <u8   number of runs begun
marks         <u8   number of marks
state         <u4   state of the robot now, also between two ticks: a code of `states`
phase         <u4   0 while a run goes on, 1 after it has ended, 2 after the session was closed
reason        S128  why the last run ended, UTF-8
records_at    <u8   offset of the first record
names_at      <u8   offset of the first slot of names
marks_at      <u8   offset of the first slot of marks
records       <u4   number of records
record_size   <u4   size of a record, bytes
name_slots    <u4   number of slots of names
name_size     <u4   size of such a slot, bytes
mark_slots    <u4   number of slots of marks
mark_size     <u4   size of such a slot, bytes
"""
_LINES = [line.split(maxsplit=2) for line in TABLE.strip().splitlines()]
HEAD: Final = np.dtype([(name, kind) for name, kind, _ in _LINES])
MEANINGS: Final = {name: meaning for name, _, meaning in _LINES}
NAME_SLOTS, NAME_SIZE = 8, 16384
MARK_SLOTS, MARK_SIZE = 64, 256
NUMBER: Final = struct.Struct("<Q")
CODE: Final = struct.Struct("<I")
SLOT: Final = struct.Struct("<QII")
"""Begin of a slot of text: its number, the size of its text, bytes, and a CRC-32 of that."""
CHECK: Final = struct.Struct("<QI")
"""Begin of a record: sequence number and checksum."""
REASON: Final = struct.Struct("<128s")


def at(name: str) -> int:
    """Return the offset of a field of the head, bytes."""
    fields = HEAD.fields
    assert fields is not None
    return int(fields[name][1])


def aligned(offset: int) -> int:
    """Return the next multiple of `ALIGNMENT`."""
    return -(-offset // ALIGNMENT) * ALIGNMENT


def checksum(number: int, payload: bytes | memoryview) -> int:
    """Return the CRC-32 of `payload`, initialised with `number`."""
    return zlib.crc32(payload, number & 0xFFFFFFFF)
