"""Reading files that people name: a device is refused, and nothing is read past a few MB."""

import errno
import os
import stat
from pathlib import Path
from typing import Final

MOST: Final = 4 * 2**20
"""The longest file that is read, bytes."""


def read_small(path: Path) -> bytes:
    """Return what is in a file.

    Raises:
        OSError: It cannot be read, is a device, or is longer than `MOST`; `strerror` says which.
    """
    mode = os.stat(path).st_mode
    if stat.S_ISCHR(mode) or stat.S_ISBLK(mode):
        raise OSError(errno.EINVAL, "this is a device, not a file")
    with path.open("rb") as file:
        data = file.read(MOST + 1)
    if len(data) > MOST:
        raise OSError(errno.EFBIG, f"longer than {MOST >> 20} MB")
    return data
