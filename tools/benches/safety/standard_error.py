"""Where program and guardian print: to a file, to a pipe that nobody reads, or nowhere."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Literal

Errors = Literal["a file", "closed", "unread"]
STANDARD_ERROR = 2


@contextmanager
def unread(path: Path) -> Iterator[None]:
    """Make a pipe, by name, that somebody holds open and does not read."""
    os.mkfifo(path)
    held = os.open(path, os.O_RDWR | os.O_NONBLOCK)
    try:
        yield
    finally:
        os.close(held)


def fill(path: Path) -> None:
    """Fill a pipe: whoever writes to it from now on waits for ever."""
    pipe = os.open(path, os.O_WRONLY | os.O_NONBLOCK)
    try:
        for size in (4096, 1):
            with suppress(BlockingIOError):
                while True:
                    os.write(pipe, b"\n" * size)
    finally:
        os.close(pipe)


def replace_standard_error(errors: Errors, path: Path) -> None:
    """Let this process print to a file or a pipe; or nowhere, as one does that `2>&-` started."""
    if errors == "closed":
        sys.stderr = sys.__stderr__ = None  # type: ignore[misc]  # as Python does it itself
        os.close(STANDARD_ERROR)
        return
    opened = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    os.dup2(opened, STANDARD_ERROR)
    os.close(opened)
