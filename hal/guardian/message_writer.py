"""Messages of the guardian on standard error, written without ever blocking the guardian."""

import os
import select
import sys
from collections.abc import Callable
from contextlib import suppress
from queue import Empty, Full, Queue
from threading import Thread

LINES = 100
"""Maximum number of queued lines; beyond it the oldest are dropped."""

WriteLine = Callable[[str], None]


class MessageWriter:
    """Writes lines in a thread of its own, so that the caller never waits for a reader.

    The descriptor is shared with other processes and must not be made non-blocking: that would
    affect all of them.

    Args:
        descriptor: Descriptor to write to; None discards the lines.
    """

    def __init__(self, descriptor: int | None) -> None:
        self._lines: Queue[bytes] = Queue(LINES)
        self._descriptor = descriptor
        self._thread = Thread(target=self._write_all, name="words", daemon=True)
        if descriptor is not None:
            self._thread.start()

    def write_line(self, text: str) -> None:
        """Queue one line for writing."""
        self._put(f"windup guardian: {text}\n".encode(errors="replace"))

    def finish(self, seconds: float) -> None:
        """Wait until all lines are written, at most `seconds` s; further lines are not written."""
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
            with suppress(OSError):  # the reader has closed
                self._write(line)

    def _write(self, line: bytes) -> None:
        assert self._descriptor is not None
        while line:
            try:
                line = line[os.write(self._descriptor, line) :]
            except BlockingIOError:  # another process made it non-blocking
                writable = select.poll()
                writable.register(self._descriptor, select.POLLOUT)
                writable.poll()


def standard_error() -> int | None:
    """Return the descriptor of standard error, or None if it is closed."""
    if sys.stderr is None:
        return None
    with suppress(OSError, ValueError):
        return sys.stderr.fileno()
    return None
