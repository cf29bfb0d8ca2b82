"""Ctrl-C between two runs of an armed robot: whoever has the robot hears of it first.

While a robot runs, signals are counted (`interrupts`). Between two runs one that raises is what it
always was for the program; that its robot has to stop nevertheless, also if the program catches
KeyboardInterrupt and goes on, is why it is overheard.
"""

import signal
from collections.abc import Callable
from threading import current_thread, main_thread
from typing import Any, Protocol
from weakref import WeakSet

from windup.tools.stopping.interrupts import WORDS


class Listener(Protocol):
    """Who wants to be told."""

    def hear(self, by: str) -> None:
        """Take note of a signal, in words."""
        ...


_listeners: "WeakSet[Listener]" = WeakSet()


class _Overheard:
    """A handler that tells the listeners of a signal, and does what was done before."""

    def __init__(self, before: Callable[[int, Any], Any]) -> None:
        self.before = before

    def __call__(self, number: int, frame: Any) -> None:
        for listener in tuple(_listeners):
            listener.hear(WORDS[signal.Signals(number)])
        self.before(number, frame)


def overhear(listener: Listener) -> None:
    """From now on tell a listener of signals that this program handles.

    Where it does not, a signal ends the process at once, and the guardian takes over. Nothing is
    overheard where this is not called in the main thread: Python sets handlers in no other.
    """
    _listeners.add(listener)
    if current_thread() is not main_thread():
        return
    for number in WORDS:
        before = signal.getsignal(number)
        if callable(before) and not isinstance(before, _Overheard):
            signal.signal(number, _Overheard(before))


def forget(listener: Listener) -> None:
    """Tell a listener no more; after the last one, signals are whose they were before."""
    _listeners.discard(listener)
    if _listeners or current_thread() is not main_thread():
        return
    for number in WORDS:
        handler = signal.getsignal(number)
        if isinstance(handler, _Overheard):
            signal.signal(number, handler.before)
