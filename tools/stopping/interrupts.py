"""Signals that ask a program to end, counted and polled at each tick of a run.

An exception could otherwise occur while the torque is being switched off. So while a robot runs or
is being stopped, signals are only counted. At other times they have their usual effect: Ctrl-C
raises KeyboardInterrupt, which ends a `with Robot.open(...)`.
"""

import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from threading import current_thread, main_thread
from typing import Any

from windup.hal.errors import UsageError

SIGNAL_NAMES = {
    signal.SIGTSTP: "Ctrl-Z",
    signal.SIGQUIT: "Ctrl-\\",
    signal.SIGHUP: "the end of the terminal",
    signal.SIGTERM: "SIGTERM",
    signal.SIGINT: "Ctrl-C",
}
"""The signals that end a run on servos. SIGINT, which raises, is last, to be restored last."""
IN_SIMULATION = (signal.SIGTERM, signal.SIGINT)
"""The signals that end a run on a twin, which may be suspended by Ctrl-Z."""
KILL_COUNT = 10
"""Number of signals that kill a program which does not end; its guardian stops the robot."""
SKIP_CROUCH_COUNT = 3
"""Number of signals from which on a stop omits the crouch."""


class RunInterruptedError(KeyboardInterrupt):
    """A run was ended by a signal, and its stop policy has been carried out.

    Attributes:
        report: Measurements of the run so far.
        by: Name of what ended it.
    """

    def __init__(self, report: Any, by: str) -> None:
        super().__init__(f"stopped by {by}")
        self.report, self.by = report, by


class BrokenOffError(RunInterruptedError):
    """A run was ended by whoever owns the robot, which is held."""

    def __str__(self) -> str:
        return self.by


@dataclass
class StopRequests:
    """The requests to end the program.

    Attributes:
        count: Number of signals, and of buttons and keys, which count as one, so far.
        by: Name of the first of them.
        raises: From the third signal on, signals raise: code of the user's own runs, which may
            never end.
    """

    count: int = 0
    by: str = ""
    raises: bool = False

    def __call__(self) -> bool:
        """Return whether the program is to end."""
        return self.count > 0

    @property
    def skip_crouch(self) -> bool:
        """Whether the stop must omit the crouch."""
        return self.count >= SKIP_CROUCH_COUNT

    def on_signal(self, number: int, frame: Any) -> None:
        """Count a signal; this is the signal handler.

        Raises:
            KeyboardInterrupt: It is the third one, and `raises` is set.
        """
        self.add(SIGNAL_NAMES[signal.Signals(number)])
        if self.raises and self.skip_crouch:
            raise KeyboardInterrupt

    def add(self, by: str) -> None:
        """Count a request, given its name."""
        self.by = self.by or by
        self.count += 1


class _OtherThreadRequests(StopRequests):
    """Requests to another thread: signals only reach the main thread, whose end is a request."""

    def __call__(self) -> bool:
        if not main_thread().is_alive():
            self.by = "the end of the main thread"
            self.count = max(self.count, 1)
        return self.count > 0


_requests: StopRequests | None = None
_stopped_by = ""
_ignored = 0


@contextmanager
def counted_signals(wired: bool = True) -> Iterator[StopRequests]:
    """Within the context, count the signals that ask this program to end.

    Args:
        wired: Whether servos are involved: Ctrl-Z, SIGQUIT and SIGHUP count too.
    """
    global _requests
    if current_thread() is not main_thread():
        yield _OtherThreadRequests()
        return
    if _requests is not None:
        yield _requests
        return
    _requests = requests = StopRequests()
    numbers = tuple(SIGNAL_NAMES) if wired else IN_SIMULATION
    before: dict[signal.Signals, Callable[[int, Any], Any] | int | None] = {}
    try:
        for number in numbers:
            before[number] = signal.signal(number, requests.on_signal)
        yield requests
    finally:
        _requests = None
        for number, handler in before.items():
            signal.signal(number, handler)


def end_on_signals() -> None:
    """Make the first signal that ends a program raise KeyboardInterrupt, and ignore the others.

    For a program that is about to end anyway: a repeating key must not interrupt its clean-up.
    """
    if current_thread() is main_thread():
        for number in (signal.SIGHUP, signal.SIGQUIT, signal.SIGTERM, signal.SIGINT):
            signal.signal(number, _end_once)


def ignore_signals() -> None:
    """Ignore all signals, so that none changes the exit status of a finished program.

    At exit Python restores the default action of signals, which kills, but not of ignored ones.
    """
    if current_thread() is main_thread():
        for number in (signal.SIGHUP, signal.SIGQUIT, signal.SIGTERM, signal.SIGINT):
            signal.signal(number, signal.SIG_IGN)


def _end_once(number: int, frame: Any) -> None:
    for each in (signal.SIGHUP, signal.SIGQUIT, signal.SIGTERM, signal.SIGINT):
        signal.signal(each, _count_ignored)
    raise KeyboardInterrupt


def _count_ignored(number: int, frame: Any) -> None:
    """Ignore a signal, but exit at once after ten of them, if the program does not end."""
    global _ignored
    _ignored += 1
    if _ignored >= KILL_COUNT:
        os._exit(130)


def note_interruption(by: str) -> None:
    """Prevent all automatic arming in this process, until `forget_interruption`."""
    global _stopped_by
    _stopped_by = by


def forget_interruption() -> None:
    """Allow arming again, after an explicit request to continue."""
    note_interruption("")


def check_not_interrupted() -> None:
    """Check that this program has not been told to end, before torque is switched on.

    Raises:
        UsageError: It has.
    """
    if _stopped_by:
        raise UsageError(
            f"{_stopped_by} has stopped this program, so torque is not switched on automatically; "
            "call robot.arm() to continue"
        )
