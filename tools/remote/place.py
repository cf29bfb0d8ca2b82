"""Where the runtime of a robot can be found: its lock, and its socket."""

import fcntl
import os
import re
from contextlib import suppress
from pathlib import Path
from typing import Final, NamedTuple, Self

import msgspec

from windup.hal.errors import UsageError
from windup.hal.stopping.folder import other_users, private_folder

LONGEST: Final = 100
"""Maximum length of the path of a Unix socket, bytes; see unix(7)."""


class Note(msgspec.Struct, frozen=True):
    """Contents of the lock file of a runtime: its process id, port and version of Windup."""

    pid: int = 0
    port: str | None = None
    version: str = ""


class Place(NamedTuple):
    """The files of the runtime of a robot.

    Attributes:
        robot: Name of the robot.
        lock: Its lock file, which a runtime holds locked as long as it lives.
        socket: Its socket.
    """

    robot: str
    lock: Path
    socket: Path

    @classmethod
    def of(cls, robot: str, folder: Path | None = None) -> Self:
        """Return the place of a robot in the private folder of this user.

        Raises:
            UsageError: There cannot be one.
        """
        folder = private_folder() if folder is None else folder
        plain = re.sub(r"[^A-Za-z0-9_-]", "_", robot)
        place = cls(robot, folder / f"{plain}.runtime", folder / f"{plain}.socket")
        if len(bytes(place.socket)) > LONGEST:
            raise UsageError(f"robot {robot!r}: the name is too long for a socket")
        return place

    def note(self) -> Note | None:
        """Return the note of the runtime that is up; None if there is none."""
        try:
            descriptor = os.open(self.lock, os.O_RDWR | os.O_CLOEXEC)
        except OSError:
            return None
        try:
            fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
            return None
        except BlockingIOError:
            return _read(descriptor)
        finally:
            os.close(descriptor)

    def not_up(self) -> UsageError:
        """Return the error for a robot that is not up, with the remedy."""
        begin = f"begin it with `windup up {self.robot}`"
        if self.socket.exists():
            return UsageError(f"{self.robot} is not up: its runtime has died; {begin} again")
        users = other_users(self.lock.parent.parent)
        if users:
            begin += f" (user {users[0]} uses Windup too; the robots of another user are its own)"
        return UsageError(f"{self.robot} is not up; {begin}, or leave --up away for its twin")


class RuntimeLock:
    """The lock of a runtime, held as long as its process lives.

    Args:
        place: The files of the runtime.
        note: What others may know about it.

    Raises:
        UsageError: The robot is up already, or the lock cannot be made.
    """

    def __init__(self, place: Place, note: Note) -> None:
        self._place = place
        try:
            flags = os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW
            self._descriptor = os.open(place.lock, flags, 0o600)
        except OSError as error:
            raise UsageError(f"{place.lock} cannot be made: {error.strerror}") from None
        try:
            fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            other = _read(self._descriptor)
            os.close(self._descriptor)
            where = "its twin" if other.port is None else other.port
            raise UsageError(
                f"{place.robot} is up already, on {where} (process {other.pid}): "
                f"`windup status {place.robot}` shows it, `windup down {place.robot}` ends it"
            ) from None
        os.ftruncate(self._descriptor, 0)
        os.pwrite(self._descriptor, msgspec.json.encode(note), 0)
        with suppress(FileNotFoundError):
            place.socket.unlink()  # of a runtime that has died: nobody else holds the lock

    def release(self) -> None:
        """Remove socket and lock."""
        for path in (self._place.socket, self._place.lock):
            with suppress(OSError):
                path.unlink()
        os.close(self._descriptor)


def _read(descriptor: int) -> Note:
    try:
        text = os.pread(descriptor, os.fstat(descriptor).st_size, 0)
        return msgspec.json.decode(text, type=Note)
    except msgspec.DecodeError:  # not written yet
        return Note()
