"""Where the telemetry rings of a user are: one private folder, in memory if possible."""

import os
import re
import stat
import tempfile
import zlib
from pathlib import Path

from windup.hal.errors import TelemetryError


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
