"""The file of a telemetry ring: created under a temporary name, then renamed."""

import contextlib
import mmap
import os
from pathlib import Path

import msgspec
import numpy as np

from windup.hal.errors import TelemetryError
from windup.hal.telemetry.header import Header
from windup.hal.telemetry.layout import (
    HEAD,
    MAGIC,
    MARK_SIZE,
    MARK_SLOTS,
    NAME_SIZE,
    NAME_SLOTS,
    VERSION,
    aligned,
)

EMPTY = bytes(65536)


def make_ring(path: Path, header: Header, records: int) -> tuple[mmap.mmap, np.void]:
    """Create a ring at `path`; return its memory map, and a copy of its head.

    Raises:
        TelemetryError: The file cannot be created.
    """
    text = msgspec.json.encode(header)
    head = _head(header, records, len(text))
    size = int(head["marks_at"]) + MARK_SLOTS * MARK_SIZE
    fresh = path.with_suffix(f".{os.getpid()}")
    try:
        with fresh.open("wb+") as file:
            # Disk space is allocated now: a full disk must not cause SIGBUS during a run.
            os.posix_fallocate(file.fileno(), 0, size)
            ring = mmap.mmap(file.fileno(), size)
        for start in range(0, size, len(EMPTY)):  # map all pages before the run
            ring[start : start + len(EMPTY)] = EMPTY[: size - start]
        ring[: HEAD.itemsize] = head.tobytes()
        ring[HEAD.itemsize : HEAD.itemsize + len(text)] = text
        fresh.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            fresh.unlink()
        raise TelemetryError(f"{path}: cannot be made: {error.strerror}") from None
    return ring, head


def _head(header: Header, records: int, json_size: int) -> np.void:
    """Return the head of a new ring."""
    head = np.zeros(1, dtype=HEAD)[0]
    records_at = aligned(HEAD.itemsize + json_size)
    names_at = aligned(records_at + records * header.record_size)
    for name, value in {
        "magic": MAGIC,
        "version": VERSION,
        "json_size": json_size,
        "records_at": records_at,
        "records": records,
        "record_size": header.record_size,
        "names_at": names_at,
        "name_slots": NAME_SLOTS,
        "name_size": NAME_SIZE,
        "marks_at": names_at + NAME_SLOTS * NAME_SIZE,
        "mark_slots": MARK_SLOTS,
        "mark_size": MARK_SIZE,
    }.items():
        head[name] = value
    return head


def read_head(ring: mmap.mmap) -> tuple[Header, np.void]:
    """Return the header of a ring and its head.

    Raises:
        ValueError: The file is not a ring, or has another version or size.
    """
    if len(ring) < 12 or ring[: len(MAGIC)] != MAGIC:
        raise ValueError("it is not telemetry")
    version = int.from_bytes(ring[8:12], "little")
    if version != VERSION:
        raise ValueError(
            f"it is telemetry of version {version}, and this program reads version {VERSION}; "
            "use the windup that wrote it"
        )
    if len(ring) < HEAD.itemsize:
        raise ValueError("it is cut")
    head = np.frombuffer(ring[: HEAD.itemsize], dtype=HEAD)[0]
    if len(ring) < int(head["marks_at"]) + int(head["mark_slots"]) * int(head["mark_size"]):
        raise ValueError("it is cut")
    text = ring[HEAD.itemsize : HEAD.itemsize + int(head["json_size"])]
    header = msgspec.json.decode(text, type=Header)
    if header.record_size != int(head["record_size"]):
        raise ValueError("its size is not what its header says")
    return header, head
