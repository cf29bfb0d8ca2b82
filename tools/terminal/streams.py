"""Standard input, output and error that may be closed, full, or read by nobody."""

import os
import sys
from contextlib import suppress
from typing import IO, Any


def fill_closed_streams() -> None:
    """Open the null device in the place of standard streams that are closed.

    The next file that is opened would get their number: what a library prints, or the traceback
    that the guardian asks for, would go to a servo bus.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest number that is free: this one


def drop_unwritten(stream: IO[str] | None) -> None:
    """Let what a stream still holds, and all that comes, go nowhere, if it cannot be written.

    The interpreter would try once more at its end, and complain.
    """
    if stream is None:
        return
    try:
        stream.flush()
    except (OSError, ValueError):
        with suppress(OSError, ValueError):  # it is none of the system's
            null = os.open(os.devnull, os.O_WRONLY)
            os.dup2(null, stream.fileno())
            os.close(null)


class StandardError:
    """Standard error as it is at the moment; writing to it never fails.

    A full disk behind `2>log`, or a pager that has quit, is no reason to stop a robot.
    """

    def write(self, text: str) -> int:
        """Write what can be written; returns how much there was."""
        with suppress(OSError, ValueError, AttributeError):
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        """Flush, if that is possible."""
        with suppress(OSError, ValueError, AttributeError):
            self._stream.flush()

    @property
    def _stream(self) -> Any:
        """What is behind; a progress bar of `rich` puts itself before it. None where closed."""
        return getattr(sys.stderr, "rich_proxied_file", sys.stderr)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)
