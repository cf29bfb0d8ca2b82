"""Standard error of program and guardian: a file, an unread pipe, or closed."""

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
    """Create a named pipe and keep it open without reading from it."""
    os.mkfifo(path)
    held = os.open(path, os.O_RDWR | os.O_NONBLOCK)
    try:
        yield
    finally:
        os.close(held)


def fill(path: Path) -> None:
    """Fill a pipe, so that every further write to it blocks."""
    pipe = os.open(path, os.O_WRONLY | os.O_NONBLOCK)
    try:
        for size in (4096, 1):
            with suppress(BlockingIOError):
                while True:
                    os.write(pipe, b"\n" * size)
    finally:
        os.close(pipe)


def replace_standard_error(errors: Errors, path: Path) -> None:
    """Replace standard error by a file or pipe, or close it, as `2>&-` does."""
    if errors == "closed":
        sys.stderr = sys.__stderr__ = None  # type: ignore[misc]  # as Python itself does
        os.close(STANDARD_ERROR)
        return
    opened = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    os.dup2(opened, STANDARD_ERROR)
    os.close(opened)
