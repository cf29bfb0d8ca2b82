"""Reads files that users name: devices are refused, and files of more than a few MB too."""

import errno
import os
import stat
from pathlib import Path
from typing import Final

MOST: Final = 4 * 2**20
"""Maximum size of a file, bytes."""


def read_small(path: Path) -> bytes:
    """Return the contents of a file.

    Raises:
        OSError: It cannot be read, is a device, or is longer than `MOST`; see `strerror`.
    """
    mode = os.stat(path).st_mode
    if stat.S_ISCHR(mode) or stat.S_ISBLK(mode):
        raise OSError(errno.EINVAL, "this is a device, not a file")
    with path.open("rb") as file:
        data = file.read(MOST + 1)
    if len(data) > MOST:
        raise OSError(errno.EFBIG, f"longer than {MOST >> 20} MB")
    return data
