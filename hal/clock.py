"""The clock on the wall."""

import contextlib
import ctypes
import gc
import os
import time
from collections.abc import Iterator

SPIN = 1.5e-4
"""The last part of a wait, not trusted to a sleep, s."""
PR_SET_TIMERSLACK = 29
PRIORITY = 10
"""Of the loop among real-time processes, 1 to 99; interrupts and the kernel's own are above."""


class WallClock:
    """Monotonic time; waiting sleeps."""

    def now(self) -> float:
        """Return the time since some moment in the past, s."""
        return time.monotonic()

    def wait_until(self, time_: float) -> None:
        """Sleep until it is `time_` s."""
        sleep_until(time_)


def sleep_until(time_: float) -> None:
    """Return when `time.monotonic()` is `time_` s: a sleep to just before it, and a short spin."""
    while (left := time_ - time.monotonic()) > 0.0:
        if left > SPIN:
            time.sleep(left - SPIN)


@contextlib.contextmanager
def punctual() -> Iterator[None]:
    """Give a loop on the wall's time precedence, exact sleeps, and no garbage collection.

    A full collection takes 10 to 20 ms. Nothing that a tick makes needs one: reference
    counts free it. Precedence is the kernel's round-robin scheduling where the user may have it
    (root, or an rtprio limit); elsewhere the loop runs as everybody else.
    """
    was = gc.isenabled()
    gc.collect()
    gc.freeze()
    gc.disable()
    _timer_slack(1)
    _precedence(True)
    try:
        yield
    finally:
        _precedence(False)
        _timer_slack(0)
        gc.unfreeze()
        if was:
            gc.enable()


def _precedence(on: bool) -> None:
    """Run before all ordinary processes, or again as one of them."""
    kind, priority = (os.SCHED_RR, PRIORITY) if on else (os.SCHED_OTHER, 0)
    with contextlib.suppress(OSError, AttributeError):
        # What is started from here, such as a planner, is no part of the loop.
        os.sched_setscheduler(0, kind | os.SCHED_RESET_ON_FORK, os.sched_param(priority))


def _timer_slack(nanoseconds: int) -> None:
    """Say how late the kernel may end a sleep of this thread; 0 for its default of 50 us."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(PR_SET_TIMERSLACK, nanoseconds)
