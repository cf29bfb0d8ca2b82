"""The file of a telemetry ring: created under a temporary name, then renamed."""

import contextlib
import mmap
import os
from pathlib import Path

import msgspec

from windup.hal.errors import TelemetryError
from windup.hal.telemetry.layout import (
    ALIGNMENT,
    FIXED,
    MAGIC,
    SIZES,
    SIZES_AT,
    VERSION,
    Header,
)

EMPTY = bytes(65536)


def make_ring(path: Path, header: Header, slots: int, size: int) -> tuple[mmap.mmap, int]:
    """Create a ring at `path`; return its memory map and the offset of the first slot.

    Raises:
        TelemetryError: The file cannot be created.
    """
    text = msgspec.json.encode(header)
    first = -(-(FIXED.size + len(text)) // ALIGNMENT) * ALIGNMENT
    head = FIXED.pack(MAGIC, VERSION, first, slots, size, 0, 0, b"", len(text)) + text
    fresh = path.with_suffix(f".{os.getpid()}")
    try:
        with fresh.open("wb+") as file:
            # Disk space is allocated now: a full disk must not cause SIGBUS during a run.
            os.posix_fallocate(file.fileno(), 0, first + slots * size)
            ring = mmap.mmap(file.fileno(), first + slots * size)
        for start in range(0, len(ring), len(EMPTY)):  # map all pages before the run
            ring[start : start + len(EMPTY)] = EMPTY[: len(ring) - start]
        ring[: len(head)] = head
        fresh.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            fresh.unlink()
        raise TelemetryError(f"{path}: cannot be made: {error.strerror}") from None
    return ring, first


def read_header(ring: mmap.mmap) -> tuple[Header, int, int]:
    """Return the header, the offset of the first slot and the number of slots.

    Raises:
        ValueError: The file is not a ring, or has another version or size.
    """
    if len(ring) < FIXED.size or ring[: len(MAGIC)] != MAGIC:
        raise ValueError("other magic")
    version, first, slots, size = SIZES.unpack_from(ring, SIZES_AT)
    if version != VERSION:
        raise ValueError(f"version {version}, this is {VERSION}")
    *_, length = FIXED.unpack_from(ring)
    header = msgspec.json.decode(ring[FIXED.size : FIXED.size + length], type=Header)
    if header.dtype().itemsize != size or len(ring) < first + slots * size:
        raise ValueError("its size is not what its header says")
    return header, first, slots
