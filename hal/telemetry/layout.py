"""Layout and location of the file of a telemetry ring.

The numbers are little-endian::

    offset  bytes  what
    0       8      magic
    8       16     version, offset of the first slot, number of slots, bytes of a slot
    24      8      sequence number of the newest tick, from 1; 0 before any
    32      4      1 after a run has ended, 2 after the session has been closed, else 0
    36      128    why the run ended, UTF-8, zero-padded
    164     4      length of the JSON that follows, a `Header`, bytes
    168     ..     JSON

followed by the slots; tick s is in slot s modulo their number. A slot consists of the sequence
number, a CRC-32 of the numbers after it (initialised with the sequence number), four unused bytes,
and float64 numbers, whose names and shapes follow from the JSON (`Header.fields`).
"""

import os
import re
import stat
import struct
import tempfile
import zlib
from pathlib import Path

import msgspec
import numpy as np

from windup.hal.command import FIELDS
from windup.hal.errors import TelemetryError

MAGIC = b"WINDUPTR"
VERSION = 2
FIXED = struct.Struct("<8sIIIIQI128sI")
SIZES = struct.Struct("<IIII")
SIZES_AT, HEAD_AT, ENDED_AT = 8, 24, 32
ENDED = struct.Struct("<I128s")
STATE = struct.Struct("<I")
RUNS, OVER, CLOSED = 0, 1, 2
HEAD = struct.Struct("<Q")
PAYLOAD_AT = 16
ALIGNMENT = 64

Field = tuple[str, tuple[int, ...]]


class Header(msgspec.Struct, frozen=True, kw_only=True):
    """The constant data of a ring.

    Attributes:
        robot: Name of the robot.
        port: URL of its port, or None for a twin.
        rate_hz: Rate of the loop, Hz.
        joints: Names of the n joints.
        contacts: Names of the k contact sensors.
        errors: Kinds of bus errors that are counted.
        alerts: Meanings of the bits of `alert`, lowest first.
        pid: Process id of the writer.
        started: Time when the writer began, s since 1970.
        clamps: Names of the clamps that the guard counts.
        estimated: Whether the base state is estimated from the IMU.
        driver_clamps: Names of the clamps that the servo driver counts.
    """

    robot: str
    port: str | None
    rate_hz: float
    joints: tuple[str, ...]
    contacts: tuple[str, ...]
    errors: tuple[str, ...]
    alerts: tuple[str, ...]
    pid: int
    started: float
    clamps: tuple[str, ...] = FIELDS
    estimated: bool = False
    driver_clamps: tuple[str, ...] = ()

    def fields(self) -> list[Field]:
        """Return the names and shapes of the numbers of a slot, in order.

        time s on the backend's clock, wall s since 1970, tick and missed ticks of the run,
        tick_time s, plans of the run and late ones | joints: rad, rad/s, N m, V, degrees C, age s,
        health_age s (age of volts and degrees) | command: target position, rad, stiffness N m/rad
        | clamped: commands in which each joint was clamped | alert: bits | IMU: wxyz, rad/s, m/s2 |
        contacts: N | base: m, wxyz, m/s, rad/s. Quantities that are not measured are NaN.
        """
        n = (len(self.joints),)
        run = ("time", "wall", "tick", "missed", "tick_time", "plans", "late_plans")
        scalars = (*run, "imu_age", "base_confidence")
        joints = ("position", "velocity", "torque", "voltage", "temperature", "age", "health_age")
        told = ("command", "stiffness", "clamped", "alert")
        return [
            *((name, ()) for name in scalars),
            ("clamps", (len(self.clamps),)),
            ("driver_clamps", (len(self.driver_clamps),)),
            ("errors", (len(self.errors),)),
            *((name, n) for name in (*joints, *told)),
            ("contacts", (len(self.contacts),)),
            ("imu_orientation", (4,)),
            ("imu_angular_velocity", (3,)),
            ("imu_acceleration", (3,)),
            ("base_position", (3,)),
            ("base_orientation", (4,)),
            ("base_linear_velocity", (3,)),
            ("base_angular_velocity", (3,)),
        ]

    def dtype(self) -> np.dtype[np.void]:
        """Return the NumPy record type of a slot."""
        numbers = [(name, "<f8", shape) for name, shape in self.fields()]
        return np.dtype([("sequence", "<u8"), ("checksum", "<u4"), ("unused", "<u4"), *numbers])


def checksum(sequence: int, payload: bytes | memoryview) -> int:
    """Return the CRC-32 of a slot's numbers `payload`, initialised with `sequence`."""
    return zlib.crc32(payload, sequence & 0xFFFFFFFF)


def ring_path(robot: str, port: str | None = None) -> Path:
    """Return the path of the ring of `robot` on `port`; None means its twin.

    >>> ring_path("op3", "/dev/ttyUSB0").name
    'op3@dev_ttyUSB0-6fb529ce.ring'
    """
    place = "twin"
    if port is not None:
        plain = re.sub(r"\W+", "_", port).strip("_")[:64]
        place = f"{plain}-{zlib.crc32(port.encode()):08x}"
    return runtime_folder() / f"{re.sub(r'[^A-Za-z0-9_-]', '_', robot)}@{place}.ring"


def runtime_folder() -> Path:
    """Return the user's private folder for rings, created if needed.

    It is in memory if possible: while a disk writes back a page, changes of that page block.

    Raises:
        TelemetryError: It belongs to another user, or cannot be created.
    """
    folder = _runtime_base()
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError as error:
        raise TelemetryError(f"{folder}: cannot be made: {error.strerror}") from None
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid():
        raise TelemetryError(f"{folder}: is not your folder; remove it or set XDG_RUNTIME_DIR")
    return folder


def _runtime_base() -> Path:
    given = os.environ.get("XDG_RUNTIME_DIR")
    if given and Path(given).is_dir():
        return Path(given) / "windup"
    memory = Path("/dev/shm")
    base = memory if os.access(memory, os.W_OK) else Path(tempfile.gettempdir())
    return base / f"windup-{os.getuid()}"
