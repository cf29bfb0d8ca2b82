"""What programs read on standard output."""

import sys

from windup.tools.terminal.streams import drop_unwritten
from windup.tools.terminal.writing import STANDARD_OUTPUT, check_writable, writing


def print_result(text: str) -> None:
    """Write to standard output, all of it, now.

    Raises:
        UsageError: It is closed.
        OutputError: That is not possible.
        BrokenPipeError: Whoever read it has gone.
    """
    check_writable(STANDARD_OUTPUT)
    with writing(STANDARD_OUTPUT):
        try:
            sys.stdout.write(text)
            sys.stdout.flush()
        except OSError:
            drop_unwritten(sys.stdout)
            raise
