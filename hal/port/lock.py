"""One armed run an adapter: a lock that host and guardian hold together.

The guardian keeps it until torque has been read back as off, so a new run waits for that. The file
says who holds it and what he does.
"""

import fcntl
import logging
import os
import time
import zlib
from contextlib import suppress
from pathlib import Path

import msgspec

from windup.hal.errors import PortError
from windup.hal.in_words import in_words
from windup.hal.port.open_port import stable_url
from windup.hal.telemetry.layout import runtime_folder

LOOK_AGAIN = 0.05
"""Between two looks at a lock that somebody holds, s."""
SAY_AGAIN = 10.0
"""Between two lines that say what is waited for, s."""
EMULATED = "twin://"
"""Ports in this process, which no guardian looks after."""
RESERVED = 3
"""Numbers below are those of standard input, output and error, open or not."""


class Note(msgspec.Struct, frozen=True):
    """Who holds a lock.

    Attributes:
        pid: The guardian, or the host before there is one.
        doing: What the guardian does about servos whose program is gone; "" while it watches.
    """

    pid: int = 0
    doing: str = ""


class AdapterLock:
    """The lock on the adapter of one bus.

    Args:
        url: Of its port; a path has to be absolute where it is used after a change of folders.

    Raises:
        PortError: The file of the lock cannot be opened.
    """

    def __init__(self, url: str) -> None:
        self.url = url
        self._descriptor = -1
        self._descriptor = _open(url)

    def take(self) -> int:
        """Take the lock and return its descriptor, for the guardian to inherit.

        Raises:
            PortError: Somebody else has it.
        """
        if not self.free():
            note = self.note()
            self.close()
            raise PortError(
                f"{self.url} belongs to another armed run (process {note.pid}); stop that first"
            )
        write_note(self._descriptor, Note(os.getpid()))
        return self._descriptor

    def free(self) -> bool:
        """Take the lock if nobody has it, and return whether it is ours."""
        while True:
            try:
                fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                return False
            if os.fstat(self._descriptor).st_nlink:
                return True
            self.close()  # it was removed as a leftover before it was ours
            self._descriptor = _open(self.url)

    def note(self) -> Note:
        """Return what its holder says."""
        try:
            size = os.fstat(self._descriptor).st_size
            return msgspec.json.decode(os.pread(self._descriptor, size, 0), type=Note)
        except msgspec.DecodeError:  # nobody has written yet
            return Note()

    def close(self) -> None:
        """Let it go, if it is not yet; a guardian that has inherited it keeps it."""
        descriptor, self._descriptor = self._descriptor, -1
        if descriptor >= 0:
            os.close(descriptor)


def write_note(descriptor: int, note: Note) -> None:
    """Say in a lock's file who holds it and what he does."""
    with suppress(OSError):
        text = msgspec.json.encode(note)
        # At once, with blanks over the rest of a longer note: somebody may be reading.
        os.pwrite(descriptor, text.ljust(os.fstat(descriptor).st_size), 0)


def wait_while_guarded(url: str) -> None:
    """Return when no guardian is busy stopping the servos on a port; say what is waited for."""
    if url.startswith(EMULATED) or not _path(url).exists():
        return
    lock, said = AdapterLock(url), -SAY_AGAIN
    try:
        while not lock.free():
            note = lock.note()
            if not note.doing:
                return  # an armed run; opening the port will say so
            if (now := time.monotonic()) - said >= SAY_AGAIN:
                said = now
                logging.getLogger(__name__).warning(
                    "waiting for the guardian of an earlier run (process %d) on %s: %s",
                    note.pid, url, note.doing,
                )  # fmt: skip
            time.sleep(LOOK_AGAIN)
    finally:
        lock.close()


def _open(url: str) -> int:
    """Return an open lock file, whose number is none of standard input, output and error.

    Those are other files in a guardian, that inherits it under its number.
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
        raise PortError(f"{url} cannot be locked for this run: {in_words(error)}") from error


def _path(url: str) -> Path:
    """Return the file of the lock on the adapter behind a URL."""
    if "://" not in url and not url.startswith("usb:"):
        real = os.path.realpath(url)
        # A pseudo-terminal that is served again has another number, but the link to it stays.
        url = os.path.abspath(url) if real.startswith("/dev/pts/") else stable_url(real)
    return runtime_folder() / f"adapter-{zlib.crc32(url.encode()):08x}.lock"
