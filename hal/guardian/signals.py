"""Signals that would end or stop a guardian: it ignores them, and lets the end of its host decide.

Whoever ends a whole service or a terminal sends them to everybody, `systemctl stop` for one. A
guardian that ended would leave the robot to a host that is just being ended too.
"""

import signal
from collections.abc import Iterator
from contextlib import contextmanager

FAULTS = {
    signal.SIGILL, signal.SIGTRAP, signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGSEGV,
    signal.SIGSYS,
}  # fmt: skip
"""Errors of the process itself, after which it cannot go on."""
IGNORED = signal.valid_signals() - FAULTS - {signal.SIGKILL, signal.SIGSTOP, signal.SIGCHLD}
"""All that can be ignored and has no use here."""


@contextmanager
def held_back() -> Iterator[None]:
    """Have the signals wait that come to this thread, and to a process that is started meanwhile.

    Such a process gets none of them before it says so itself, also while it is only starting.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, IGNORED)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def ignore_signals() -> None:
    """Ignore the signals in this process, those too that wait already."""
    for number in IGNORED:
        signal.signal(number, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, IGNORED)
