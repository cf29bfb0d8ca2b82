"""Signal handler that prints the stacks of all threads, even while they run C code."""

import faulthandler
import signal
import sys
from contextlib import suppress

WHERE = signal.SIGRTMIN + 3
"""The signal: a real-time signal that is otherwise unused; unhandled, it ends the process."""


def show_traceback_on_signal() -> None:
    """Install the handler: on `WHERE`, the stacks of all threads are printed to standard error."""
    stream = sys.__stderr__
    if stream is None:
        return
    with suppress(OSError, ValueError):  # standard error is closed, or not a file
        faulthandler.register(WHERE, file=stream, all_threads=True, chain=False)
