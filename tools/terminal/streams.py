"""Handles standard streams that are closed, full, or without a reader."""

import os
import sys
from contextlib import suppress
from typing import IO, Any


def fill_closed_streams() -> None:
    """Open the null device in place of closed standard streams.

    Otherwise the next opened file would get their number: output of a library, or the traceback
    that the guardian requests, would be sent to a servo bus.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest free number, which is this one


def drop_unwritten(stream: IO[str] | None) -> None:
    """Discard the unwritten text of a stream and all later text, if it cannot be written.

    The interpreter would otherwise try to flush it at exit, and print an error.
    """
    if stream is None:
        return
    try:
        stream.flush()
    except (OSError, ValueError):
        with suppress(OSError, ValueError):  # a stream without a descriptor
            null = os.open(os.devnull, os.O_WRONLY)
            os.dup2(null, stream.fileno())
            os.close(null)


class StandardError:
    """The present standard error; writing to it never raises.

    A full disk behind `2>log`, or a pager that has quit, must not stop a robot.
    """

    def write(self, text: str) -> int:
        """Write the text if possible; return its length."""
        with suppress(OSError, ValueError, AttributeError):
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        """Flush if possible."""
        with suppress(OSError, ValueError, AttributeError):
            self._stream.flush()

    @property
    def _stream(self) -> Any:
        """The underlying stream, behind a progress bar of `rich` if any; None if closed."""
        return getattr(sys.stderr, "rich_proxied_file", sys.stderr)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)
