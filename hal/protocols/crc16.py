"""CRC-16 of Dynamixel protocol 2: polynomial 0x8005, initial value 0, not reflected.

With an initial value of 0 the CRC is linear: the CRC of a frame is the XOR of one term per byte,
and each term depends only on the byte and on its distance from the end. `distance_table` contains
those terms, so that numpy checks a block of frames without a loop.
"""

from functools import lru_cache

import numpy as np
import numpy.typing as npt

POLYNOMIAL = 0x8005


def _byte(value: int) -> int:
    crc = value << 8
    for _ in range(8):
        crc = (crc << 1) ^ (POLYNOMIAL if crc & 0x8000 else 0)
    return crc & 0xFFFF


TABLE = tuple(_byte(value) for value in range(256))


def crc16(data: bytes | bytearray | memoryview, crc: int = 0) -> int:
    """Return the CRC of `data`, continuing from `crc`.

    >>> hex(crc16(bytes.fromhex("fffffd00010300 01")))
    '0x4e19'
    """
    table = TABLE
    for byte in data:
        crc = (crc << 8 & 0xFFFF) ^ table[crc >> 8 ^ byte]
    return crc


@lru_cache(maxsize=8)
def distance_table(length: int) -> npt.NDArray[np.uint16]:
    """Return (length, 256) CRC terms: row d has those of a byte that d more bytes follow."""
    table = np.array(TABLE, dtype=np.uint16)
    rows = np.empty((length, 256), dtype=np.uint16)
    row = table
    for distance in range(length):
        rows[distance] = row
        row = (row << 8) ^ table[row >> 8]
    rows.setflags(write=False)
    return rows
