"""Ctrl-C and SIGTERM as a question that the loop asks each tick, instead of an exception anywhere.

An exception that comes between any two instructions can come in the middle of switching the torque
off. During a run the signals are only remembered; a second Ctrl-C is an exception again.
"""

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from typing import Any

SIGNALS = (signal.SIGINT, signal.SIGTERM)


@contextmanager
def asked_to_end() -> Iterator[Callable[[], bool]]:
    """Yield a function that says whether somebody has asked this process to end."""
    asked: list[int] = []

    def remember(number: int, frame: Any) -> None:
        if asked:
            raise KeyboardInterrupt
        asked.append(number)

    if current_thread() is not main_thread():  # Python hands signals to the main thread alone
        yield lambda: False
        return
    before = {number: signal.signal(number, remember) for number in SIGNALS}
    try:
        yield lambda: bool(asked)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
