"""Checks that results can be written before anything moves, and reports failures in one line."""

import os
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from windup.hal.errors import OutputError, UsageError

STANDARD_OUTPUT = Path("-")


def check_writable(*targets: Path | None) -> None:
    """Check that the result files can be written, before anything runs.

    Args:
        *targets: The files; "-" is standard output, None is ignored.

    Raises:
        UsageError: One is a folder or closed, its folder is missing, or permission is denied.
    """
    for target in targets:
        if target is not None and (why := _problem(target)):
            raise UsageError(f"{_named(target)} cannot be written: {why}")


def check_folder(folder: Path) -> None:
    """Check that a folder exists and is writable, or can be created, before anything runs.

    Raises:
        UsageError: It is not writable, or cannot be created.
    """
    if not os.path.isdir(folder):
        check_writable(folder)
        if os.path.exists(folder):
            raise UsageError(f"{folder} cannot be written: this is a file, not a folder")
    elif not os.access(folder, os.W_OK):
        raise UsageError(f"{folder} cannot be written: permission denied")


@contextmanager
def writing(target: Path) -> Iterator[None]:
    """Convert an error while writing a result into a one-line `OutputError`.

    Raises:
        OutputError: The result cannot be written.
        BrokenPipeError: Its reader has closed the pipe.
    """
    try:
        yield
    except BrokenPipeError:
        raise
    except (OSError, UnicodeError) as error:
        why = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise OutputError(f"{_named(target)} cannot be written: {why}") from None


def _problem(target: Path) -> str:
    """Return the reason why a file cannot be written; "" if none is known."""
    if target == STANDARD_OUTPUT:
        return "it is closed" if sys.stdout is None else ""
    folder = os.path.dirname(os.path.realpath(target))
    if not os.path.isdir(folder):
        return f"there is no folder {folder}"
    try:
        mode = os.stat(target).st_mode
    except FileNotFoundError:
        return "" if os.access(folder, os.W_OK) else "permission denied"
    except OSError as error:
        return error.strerror or str(error)
    if stat.S_ISDIR(mode):
        return "this is a folder, not a file"
    return "" if os.access(target, os.W_OK) else "permission denied"


def _named(target: Path) -> str:
    return "standard output" if target == STANDARD_OUTPUT else str(target)
