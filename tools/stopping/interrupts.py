"""Signals that ask a program to end, as a question that is asked each tick.

An exception between any two instructions could come in the middle of switching the torque off. So
while a robot runs or is being stopped, signals are only counted. Elsewhere they are what they
always are: Ctrl-C raises KeyboardInterrupt, which ends a `with Robot.open(...)`.
"""

import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from threading import current_thread, main_thread
from typing import Any

from windup.hal.errors import UsageError

WORDS = {
    signal.SIGTSTP: "Ctrl-Z",
    signal.SIGQUIT: "Ctrl-\\",
    signal.SIGHUP: "the end of its terminal",
    signal.SIGTERM: "SIGTERM",
    signal.SIGINT: "Ctrl-C",
}
"""The signals that end a run on servos. The last is given back last: it is the one that raises."""
IN_SIMULATION = (signal.SIGTERM, signal.SIGINT)
"""The signals that end a run on a twin, which may be suspended by Ctrl-Z."""
LAST_STRAW = 10
"""So many signals end a program that does not come to its end; a guardian stops its robot."""
IMPATIENT = 3
"""So many signals leave out the crouch of a stop."""


class RunInterruptedError(KeyboardInterrupt):
    """A run was ended by a signal, and its stop policy has been carried out.

    Attributes:
        report: What had been measured until then.
    """

    def __init__(self, report: Any, by: str) -> None:
        super().__init__(f"stopped by {by}")
        self.report = report


@dataclass
class Asked:
    """Who has asked the program to end.

    Attributes:
        count: Number of signals, and of buttons and keys that count as one, so far.
        by: The first of them, in words.
    """

    count: int = 0
    by: str = ""

    def __call__(self) -> bool:
        """Return whether the program is to end."""
        return self.count > 0

    @property
    def impatient(self) -> bool:
        """True when the stop shall not take the time to crouch."""
        return self.count >= IMPATIENT

    def remember(self, number: int, frame: Any) -> None:
        """Count a signal: the handler."""
        self.add(WORDS[signal.Signals(number)])

    def add(self, by: str) -> None:
        """Count a wish of somebody, in words."""
        self.by = self.by or by
        self.count += 1


class _Elsewhere(Asked):
    """Asked in another thread: Python tells signals to the main thread alone, which then ends."""

    def __call__(self) -> bool:
        if not main_thread().is_alive():
            self.by = "the end of the main thread"
            self.count = max(self.count, 1)
        return self.count > 0


_asked: Asked | None = None
_stopped_by = ""
_ignored = 0


@contextmanager
def counted_signals(wired: bool = True) -> Iterator[Asked]:
    """Within, signals that ask this program to end are counted and interrupt nothing.

    Args:
        wired: Servos are at stake: also Ctrl-Z, SIGQUIT and the end of the terminal count.
    """
    global _asked
    if current_thread() is not main_thread():
        yield _Elsewhere()
        return
    if _asked is not None:
        yield _asked
        return
    _asked = asked = Asked()
    numbers = tuple(WORDS) if wired else IN_SIMULATION
    before: dict[signal.Signals, Callable[[int, Any], Any] | int | None] = {}
    try:
        for number in numbers:
            before[number] = signal.signal(number, asked.remember)
        yield asked
    finally:
        _asked = None
        for number, handler in before.items():
            signal.signal(number, handler)


def end_on_signals() -> None:
    """Let the first of the signals that end a program raise KeyboardInterrupt, and no other.

    For a program that is about to end anyway: a key that repeats must not break its last words.
    """
    if current_thread() is main_thread():
        for number in (signal.SIGHUP, signal.SIGQUIT, signal.SIGTERM, signal.SIGINT):
            signal.signal(number, _end_once)


def ignore_signals() -> None:
    """Let no signal change the exit status of a program that has done everything.

    At its very end Python gives signals back their first meaning: death. Not of ignored ones.
    """
    if current_thread() is main_thread():
        for number in (signal.SIGHUP, signal.SIGQUIT, signal.SIGTERM, signal.SIGINT):
            signal.signal(number, signal.SIG_IGN)


def _end_once(number: int, frame: Any) -> None:
    for each in (signal.SIGHUP, signal.SIGQUIT, signal.SIGTERM, signal.SIGINT):
        signal.signal(each, _count_on)
    raise KeyboardInterrupt


def _count_on(number: int, frame: Any) -> None:
    """Ignore a signal, unless the program is too busy to end: ten of them kill it."""
    global _ignored
    _ignored += 1
    if _ignored >= LAST_STRAW:
        os._exit(130)


def note_interruption(by: str) -> None:
    """From now on nothing arms by itself in this process, until `forget_interruption`."""
    global _stopped_by
    _stopped_by = by


def forget_interruption() -> None:
    """Somebody wants to go on, and says so."""
    note_interruption("")


def check_not_interrupted() -> None:
    """Refuse to switch torque on in a program that was told to end.

    Raises:
        UsageError: It was.
    """
    if _stopped_by:
        raise UsageError(
            f"{_stopped_by} has stopped this program: no torque comes on by itself any more; "
            "call robot.arm() to go on all the same"
        )
