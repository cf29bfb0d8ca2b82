"""What was made of the files of a folder, kept as long as they do not change."""

import os
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Generic, TypeVar

Made = TypeVar("Made")
Stamp = tuple[tuple[int, int, int], ...]

FRESH = 0.1
"""A file that is younger may change again without a newer time of its own, s."""


class Loaded(Generic[Made]):
    """Keeps what was made of the folders that were read last.

    Args:
        most: How many.
    """

    def __init__(self, most: int = 32) -> None:
        self._most = most
        self._kept: dict[tuple[str, str], tuple[Sequence[Path], Stamp, Made]] = {}

    def of(self, folder: Path) -> Made | None:
        """Return what was made of a folder, if its files are still the same."""
        kept = self._kept.get(_key(folder))
        if kept is None:
            return None
        files, stamp, made = kept
        return made if _stamp(files) == stamp else None

    def keep(self, folder: Path, files: Sequence[Path], made: Made) -> None:
        """Keep what was made of the `files` of a folder, unless one has only just been written."""
        stamp = _stamp(files)
        newest = max((changed for changed, _, _ in stamp), default=0)
        if len(stamp) == len(files) and time.time() - newest * 1e-9 > FRESH:
            self._kept.pop(_key(folder), None)
            self._kept[_key(folder)] = (files, stamp, made)
            while len(self._kept) > self._most:
                del self._kept[next(iter(self._kept))]


def _key(folder: Path) -> tuple[str, str]:
    """Return the folder as it was named, which messages repeat, and where that is now."""
    return str(folder), os.path.abspath(folder)


def _stamp(files: Sequence[Path]) -> Stamp:
    """Return time, size and inode of each file; nothing if one is not there."""
    try:
        found = [os.stat(file) for file in files]
    except OSError:
        return ()
    return tuple((item.st_mtime_ns, item.st_size, item.st_ino) for item in found)
