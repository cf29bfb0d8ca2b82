"""Lock files that allow one armed run per adapter; host and guardian hold the lock together.

The guardian keeps it until torque has been read back as off, so a new run waits for that. The file
contains the holder's process id and its present activity.
"""

import fcntl
import logging
import os
import time
import zlib
from contextlib import suppress
from pathlib import Path

import msgspec

from windup.hal.error_text import error_text
from windup.hal.errors import PortError
from windup.hal.port.open_port import stable_url
from windup.hal.telemetry.runtime_folder import runtime_folder

POLL_PERIOD = 0.05
"""Time between two attempts to take a lock that is held, s."""
MESSAGE_PERIOD = 10.0
"""Time between two log messages while waiting, s."""
EMULATED = "twin://"
"""URL prefix of ports emulated in this process, which need no guardian."""
RESERVED = 3
"""First usable descriptor number; those below are reserved for standard input, output and error."""


class LockNote(msgspec.Struct, frozen=True):
    """Contents of a lock file.

    Attributes:
        pid: Process id of the guardian, or of the host before the guardian has started.
        doing: What the guardian does during a takeover, for messages; "" while it only watches.
    """

    pid: int = 0
    doing: str = ""


class AdapterLock:
    """The lock on the adapter of one bus.

    Args:
        url: URL of its port; a path has to be absolute if the working folder may change.

    Raises:
        PortError: The file of the lock cannot be opened.
    """

    def __init__(self, url: str) -> None:
        self.url = url
        self._descriptor = -1
        self._descriptor = _open(url)

    def acquire(self) -> int:
        """Take the lock and return its descriptor, for the guardian to inherit.

        Raises:
            PortError: Another process holds it.
        """
        if not self.try_acquire():
            note = self.note()
            self.close()
            raise PortError(
                f"{self.url} is in use by another armed run (process {note.pid}); "
                "stop that run first"
            )
        write_note(self._descriptor, LockNote(os.getpid()))
        return self._descriptor

    def try_acquire(self) -> bool:
        """Take the lock if it is free, and return whether this process holds it now."""
        while True:
            try:
                fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                return False
            if os.fstat(self._descriptor).st_nlink:
                return True
            self.close()  # the file was removed as a leftover before it was locked
            self._descriptor = _open(self.url)

    def note(self) -> LockNote:
        """Return the note of its holder."""
        try:
            size = os.fstat(self._descriptor).st_size
            return msgspec.json.decode(os.pread(self._descriptor, size, 0), type=LockNote)
        except msgspec.DecodeError:  # not written yet
            return LockNote()

    def close(self) -> None:
        """Close the descriptor, if it is open; a guardian that has inherited it keeps the lock."""
        descriptor, self._descriptor = self._descriptor, -1
        if descriptor >= 0:
            os.close(descriptor)


def write_note(descriptor: int, note: LockNote) -> None:
    """Write the note of the present holder into a lock file."""
    with suppress(OSError):
        text = msgspec.json.encode(note)
        # In one write, padded to overwrite a longer note: another process may be reading.
        os.pwrite(descriptor, text.ljust(os.fstat(descriptor).st_size), 0)


def wait_while_guarded(url: str) -> None:
    """Wait until no guardian is stopping the servos on a port; log what is waited for."""
    if url.startswith(EMULATED) or not _path(url).exists():
        return
    lock, said = AdapterLock(url), -MESSAGE_PERIOD
    try:
        while not lock.try_acquire():
            note = lock.note()
            if not note.doing:
                return  # an armed run; opening the port will report it
            if (now := time.monotonic()) - said >= MESSAGE_PERIOD:
                said = now
                logging.getLogger(__name__).warning(
                    "waiting for the guardian of an earlier run (process %d) on %s: %s",
                    note.pid, url, note.doing,
                )  # fmt: skip
            time.sleep(POLL_PERIOD)
    finally:
        lock.close()


def _open(url: str) -> int:
    """Open a lock file; return its descriptor, which is not one of the standard streams (0 to 2).

    The guardian inherits the lock under the same number, and has its own standard streams.
    """
    try:
        number = os.open(_path(url), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        if number >= RESERVED:
            return number
        try:
            return fcntl.fcntl(number, fcntl.F_DUPFD_CLOEXEC, RESERVED)
        finally:
            os.close(number)
    except OSError as error:
        raise PortError(f"{url} cannot be locked: {error_text(error)}") from error


def _path(url: str) -> Path:
    """Return the path of the lock file for the adapter of a URL."""
    if "://" not in url and not url.startswith("usb:"):
        real = os.path.realpath(url)
        # A restarted pseudo-terminal has another number, but the link to it keeps its path.
        url = os.path.abspath(url) if real.startswith("/dev/pts/") else stable_url(real)
    return runtime_folder() / f"adapter-{zlib.crc32(url.encode()):08x}.lock"
