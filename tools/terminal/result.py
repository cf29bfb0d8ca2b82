"""Writes results to standard output."""

import sys
from typing import Final

from windup.tools.terminal.streams import drop_unwritten
from windup.tools.terminal.writing import STANDARD_OUTPUT, check_writable, writing

SCHEMA: Final = 1
"""Version of the keys of JSON results."""


def print_result(text: str) -> None:
    """Write a text to standard output and flush it.

    Raises:
        UsageError: Standard output is closed.
        OutputError: It cannot be written.
        BrokenPipeError: Its reader has closed it.
    """
    check_writable(STANDARD_OUTPUT)
    with writing(STANDARD_OUTPUT):
        try:
            sys.stdout.write(text)
            sys.stdout.flush()
        except OSError:
            drop_unwritten(sys.stdout)
            raise
