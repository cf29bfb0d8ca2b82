"""Keys of the terminal that stop a run: the space bar and q, without Enter.

The terminal delivers each key at once (cbreak mode) during a run only; Ctrl-C and Ctrl-Z keep their
effect. Keys are polled once per tick, with a time-out of zero.
"""

import os
import select
import sys
import termios
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

KEYS = {b" ": "the space bar", b"q": "the key q", b"Q": "the key q"}

Ask = Callable[[], str | None]
"""Function that returns the name of a stop key that has been pressed, or None."""


def keyboard() -> int | None:
    """Return the descriptor of standard input if a user can press keys there, else None.

    It must be a terminal, with this process in its foreground: a background process would be
    suspended for reading from it.
    """
    try:
        descriptor = sys.stdin.fileno()
    except (AttributeError, OSError, ValueError):  # None, closed, or not a system file
        return None
    return descriptor if os.isatty(descriptor) and _in_foreground(descriptor) else None


@contextmanager
def stop_keys(descriptor: int | None) -> Iterator[Ask]:
    """Yield a function that returns the name of the stop key that has been pressed, or None.

    Keys pressed before the run count too, because they were meant to stop it.

    Args:
        descriptor: Descriptor of a terminal, from `keyboard`; with None no key stops the run.
    """
    if descriptor is None:
        yield lambda: None
        return
    before = termios.tcgetattr(descriptor)
    tty.setcbreak(descriptor, termios.TCSANOW)
    try:
        yield lambda: _pressed(descriptor)
    finally:
        with suppress(termios.error):  # the terminal has been closed
            termios.tcsetattr(descriptor, termios.TCSANOW, before)


def _pressed(descriptor: int) -> str | None:
    """Return the name of the first stop key among the unread input."""
    waiting = select.poll()  # select() takes no descriptor beyond 1023
    waiting.register(descriptor, select.POLLIN)
    if not waiting.poll(0) or not _in_foreground(descriptor):
        return None
    try:
        typed = os.read(descriptor, 64)
    except OSError:  # the terminal hung up, which SIGHUP reports
        return None
    return next((name for key, name in KEYS.items() if key in typed), None)


def _in_foreground(descriptor: int) -> bool:
    """Return whether this process is in the foreground of the terminal."""
    try:
        return os.tcgetpgrp(descriptor) == os.getpgrp()
    except OSError:
        return False
