"""Makes the guardian ignore signals that would end or suspend it; it ends after its host.

Stopping a service (`systemctl stop`) or closing a terminal signals all processes. A guardian that
ended then could not stop the robot, while its host is being ended too.
"""

import signal
from collections.abc import Iterator
from contextlib import contextmanager

FAULTS = {
    signal.SIGILL, signal.SIGTRAP, signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGSEGV,
    signal.SIGSYS,
}  # fmt: skip
"""Signals of faults of the process itself, after which it cannot continue."""
IGNORED = signal.valid_signals() - FAULTS - {signal.SIGKILL, signal.SIGSTOP, signal.SIGCHLD}
"""All other signals that can be ignored and are not needed here."""


@contextmanager
def signals_blocked() -> Iterator[None]:
    """Block the signals in this thread, and in processes started inside the `with` block.

    In such a process they stay blocked until it unblocks them itself, also during its start.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, IGNORED)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def ignore_signals() -> None:
    """Ignore the signals in this process, including pending ones."""
    for number in IGNORED:
        signal.signal(number, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, IGNORED)
