"""Notifies armed robots of Ctrl-C and other signals between two runs.

While a robot runs, signals are counted (see `interrupts`). Between two runs a signal has its usual
effect on the program. The robot must stop nevertheless, even if the program catches
KeyboardInterrupt and continues; therefore listeners are notified first.
"""

import signal
from collections.abc import Callable
from threading import current_thread, main_thread
from typing import Any, Protocol
from weakref import WeakSet

from windup.tools.stopping.interrupts import SIGNAL_NAMES


class SignalListener(Protocol):
    """An object that is notified of signals."""

    def on_signal(self, by: str) -> None:
        """Process a signal, given its name."""
        ...


_listeners: "WeakSet[SignalListener]" = WeakSet()


class _NotifyingHandler:
    """A signal handler that notifies the listeners, and then calls the previous handler."""

    def __init__(self, before: Callable[[int, Any], Any]) -> None:
        self.before = before

    def __call__(self, number: int, frame: Any) -> None:
        for listener in tuple(_listeners):
            listener.on_signal(SIGNAL_NAMES[signal.Signals(number)])
        self.before(number, frame)


def add_signal_listener(listener: SignalListener) -> None:
    """Notify a listener of the signals that this program handles, from now on.

    A signal without a handler ends the process at once, and the guardian takes over. Outside of the
    main thread this has no effect on handlers, because Python can only set them there.
    """
    _listeners.add(listener)
    if current_thread() is not main_thread():
        return
    for number in SIGNAL_NAMES:
        before = signal.getsignal(number)
        if callable(before) and not isinstance(before, _NotifyingHandler):
            signal.signal(number, _NotifyingHandler(before))


def remove_signal_listener(listener: SignalListener) -> None:
    """Stop notifying a listener; after the last one, restore the previous handlers."""
    _listeners.discard(listener)
    if _listeners or current_thread() is not main_thread():
        return
    for number in SIGNAL_NAMES:
        handler = signal.getsignal(number)
        if isinstance(handler, _NotifyingHandler):
            signal.signal(number, handler.before)
