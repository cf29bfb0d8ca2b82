"""What a guardian says: on standard error, where nobody may be reading."""

import os
import select
import sys
from collections.abc import Callable
from contextlib import suppress
from queue import Empty, Full, Queue
from threading import Thread

LINES = 100
"""That wait for a reader at most; the oldest are lost."""

Say = Callable[[str], None]


class Words:
    """Lines that are written by a thread of their own: saying one never waits for a reader.

    A descriptor that is shared must not be made non-blocking: it would be so for everybody.

    Args:
        descriptor: Where to; None where there is nothing to write to.
    """

    def __init__(self, descriptor: int | None) -> None:
        self._lines: Queue[bytes] = Queue(LINES)
        self._descriptor = descriptor
        self._thread = Thread(target=self._write_all, name="words", daemon=True)
        if descriptor is not None:
            self._thread.start()

    def say(self, text: str) -> None:
        """Have one line written soon."""
        self._put(f"windup guardian: {text}\n".encode(errors="replace"))

    def finish(self, seconds: float) -> None:
        """Wait until all has been written, so many s at most; nothing is written after that."""
        if self._thread.is_alive():
            self._put(b"")
            self._thread.join(seconds)

    def _put(self, line: bytes) -> None:
        while self._lines.full():
            with suppress(Empty):
                self._lines.get_nowait()
        with suppress(Full):
            self._lines.put_nowait(line)

    def _write_all(self) -> None:
        while line := self._lines.get():
            with suppress(OSError):  # the reader has gone
                self._write(line)

    def _write(self, line: bytes) -> None:
        assert self._descriptor is not None
        while line:
            try:
                line = line[os.write(self._descriptor, line) :]
            except BlockingIOError:  # somebody else has made it so
                writable = select.poll()
                writable.register(self._descriptor, select.POLLOUT)
                writable.poll()


def standard_error() -> int | None:
    """Return the descriptor of standard error, or None where it was closed."""
    if sys.stderr is None:
        return None
    with suppress(OSError, ValueError):
        return sys.stderr.fileno()
    return None
