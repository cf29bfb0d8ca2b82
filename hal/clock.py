"""Wall clock, precise sleeping, and real-time settings for a loop on wall time."""

import contextlib
import ctypes
import gc
import os
import time
from collections.abc import Iterator

SPIN_TIME = 1.5e-4
"""Last part of a wait, spent spinning instead of sleeping, s."""
PR_SET_TIMERSLACK = 29
PRIORITY = 10
"""Real-time priority of the loop, 1 to 99; interrupt and kernel threads have higher ones."""


class WallClock:
    """Monotonic time of the host; `wait_until` sleeps."""

    def now(self) -> float:
        """Return the time since an arbitrary fixed instant, s."""
        return time.monotonic()

    def wait_until(self, time_: float) -> None:
        """Sleep until it is `time_` s."""
        sleep_until(time_)


def sleep_until(time_: float) -> None:
    """Block until `time.monotonic()` is `time_` s: sleep to just before it, then spin."""
    while (left := time_ - time.monotonic()) > 0.0:
        if left > SPIN_TIME:
            time.sleep(left - SPIN_TIME)


_kept = False


@contextlib.contextmanager
def objects_kept() -> Iterator[None]:
    """Keep all objects that exist now out of every garbage collection inside the `with` block.

    The collection before each loop then takes less than a millisecond: a guardian, which waits
    0.15 s for a heartbeat, would take a long one between two loops for a program that hangs.
    """
    global _kept
    gc.collect()
    gc.freeze()
    _kept = True
    try:
        yield
    finally:
        _kept = False
        gc.unfreeze()


@contextlib.contextmanager
def real_time_loop() -> Iterator[None]:
    """Run a loop with real-time priority, exact sleeps, and garbage collection switched off.

    A full collection takes 10 to 20 ms, and a tick does not need one: reference counting frees
    all objects it makes. The priority is the kernel's round-robin scheduling where the user may
    set it (root, or an rtprio limit); otherwise the loop keeps ordinary scheduling.
    """
    was = gc.isenabled()
    gc.collect()
    if not _kept:
        gc.freeze()
    gc.disable()
    _timer_slack(1)
    _set_scheduling(True)
    try:
        yield
    finally:
        _set_scheduling(False)
        _timer_slack(0)
        if not _kept:
            gc.unfreeze()
        if was:
            gc.enable()


def _set_scheduling(on: bool) -> None:
    """Switch this process to real-time scheduling, or back to ordinary scheduling."""
    kind, priority = (os.SCHED_RR, PRIORITY) if on else (os.SCHED_OTHER, 0)
    with contextlib.suppress(OSError, AttributeError):
        # Child processes, such as the planner, do not inherit the real-time scheduling.
        os.sched_setscheduler(0, kind | os.SCHED_RESET_ON_FORK, os.sched_param(priority))


def _timer_slack(nanoseconds: int) -> None:
    """Set how late the kernel may end a sleep of this thread; 0 restores its default of 50 us."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(PR_SET_TIMERSLACK, nanoseconds)
