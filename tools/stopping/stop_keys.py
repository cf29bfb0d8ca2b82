"""Keys of the terminal that stop a run: the space bar and q, without Enter.

The terminal hands over each key at once (cbreak mode) for the time of a run only; Ctrl-C and Ctrl-Z
stay what they are. Nobody waits for a key: once a tick one is asked for, with a time-out of zero.
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
"""Returns the name of a stop key that has been pressed, or None."""


def keyboard() -> int | None:
    """Return the descriptor of standard input where somebody can press keys, else None.

    That is a terminal, and this process is in its foreground: one in the background would be
    suspended for asking.
    """
    try:
        descriptor = sys.stdin.fileno()
    except (AttributeError, OSError, ValueError):  # none, closed, or an object of Python's own
        return None
    return descriptor if os.isatty(descriptor) and _in_foreground(descriptor) else None


@contextmanager
def stop_keys(descriptor: int | None) -> Iterator[Ask]:
    """Yield a function that says which stop key has been pressed.

    Keys that were typed ahead of the run count: whoever pressed one meant to stop.

    Args:
        descriptor: A terminal's, as `keyboard` returns it; without one no key ever stops.
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
    """Return the name of the first stop key among those that wait to be read."""
    waiting = select.poll()  # select() takes no descriptor beyond 1023
    waiting.register(descriptor, select.POLLIN)
    if not waiting.poll(0) or not _in_foreground(descriptor):
        return None
    try:
        typed = os.read(descriptor, 64)
    except OSError:  # hung up; SIGHUP says so
        return None
    return next((name for key, name in KEYS.items() if key in typed), None)


def _in_foreground(descriptor: int) -> bool:
    """Does the terminal listen to this process now? False too where it is not ours."""
    try:
        return os.tcgetpgrp(descriptor) == os.getpgrp()
    except OSError:
        return False
