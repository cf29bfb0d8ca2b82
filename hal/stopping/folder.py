"""The private folder in shared memory where the processes of one user find each other.

Its path depends on the user id and on nothing else: a terminal, a service and a cron job, whatever
their environment, see the same runs.
"""

import os
import stat
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from windup.hal.errors import UsageError

BASE = Path("/dev/shm")
"""Where the folders of all users are. It is in memory: a disk would block its writers."""
PREFIX = "windup-"


def private_folder(base: Path | None = None) -> Path:
    """Return the folder of this user, created if needed.

    Raises:
        UsageError: It belongs to another user, others may enter it, or it cannot be created.
    """
    folder = (base or BASE) / f"{PREFIX}{os.getuid()}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
    except OSError as error:
        raise UsageError(f"{folder} cannot be made: {error.strerror}") from None
    if (why := _wrong(folder, os.getuid())) is not None:
        raise UsageError(f"{folder} {why}; remove it")
    return folder


def folders_to_search(base: Path | None = None) -> Iterator[Path]:
    """Yield the existing folders whose runs this user may stop: the own one, for root all."""
    base = base or BASE
    own = base / f"{PREFIX}{os.getuid()}"
    for folder in sorted(base.glob(f"{PREFIX}*")) if os.getuid() == 0 else [own]:
        with suppress(ValueError):
            if _wrong(folder, int(folder.name.removeprefix(PREFIX))) is None:
                yield folder


def other_users(base: Path | None = None) -> list[int]:
    """Return the ids of the other users that have such a folder."""
    found = []
    for folder in (base or BASE).glob(f"{PREFIX}*"):
        with suppress(OSError, ValueError):
            uid = int(folder.name.removeprefix(PREFIX))
            if uid != os.getuid() and folder.lstat().st_uid == uid:
                found.append(uid)
    return sorted(found)


def _wrong(folder: Path, uid: int) -> str | None:
    """Return why a path is not the private folder of user `uid`, or None if it is."""
    try:
        found = folder.lstat()
    except OSError as error:
        return f"cannot be read: {error.strerror}"
    if not stat.S_ISDIR(found.st_mode):
        return "is no folder"
    if found.st_uid != uid:
        return f"belongs to user {found.st_uid}"
    return None if not found.st_mode & 0o077 else "is open to other users"
