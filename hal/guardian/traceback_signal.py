"""A signal on which this process prints where each of its threads is, even in the middle of C."""

import faulthandler
import signal
import sys
from contextlib import suppress

WHERE = signal.SIGRTMIN + 3
"""The signal. Nobody else uses it, and without a handler it would end the process."""


def show_traceback_on_signal() -> None:
    """From now on print the stacks of all threads to standard error on `WHERE`."""
    stream = sys.__stderr__
    if stream is None:
        return
    with suppress(OSError, ValueError):  # standard error is closed, or no file
        faulthandler.register(WHERE, file=stream, all_threads=True, chain=False)
