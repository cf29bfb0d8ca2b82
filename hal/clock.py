"""The clock on the wall."""

import contextlib
import ctypes
import gc
import time
from collections.abc import Iterator

SPIN = 1.5e-4
"""The last part of a wait, not trusted to a sleep, s."""
PR_SET_TIMERSLACK = 29


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
    """Give a loop on the wall's time exact sleeps and no garbage collection while it runs.

    A full collection takes 10 to 20 ms. Nothing that a tick makes needs one: reference
    counts free it.
    """
    was = gc.isenabled()
    gc.collect()
    gc.freeze()
    gc.disable()
    _timer_slack(1)
    try:
        yield
    finally:
        _timer_slack(0)
        gc.unfreeze()
        if was:
            gc.enable()


def _timer_slack(nanoseconds: int) -> None:
    """Say how late the kernel may end a sleep of this thread; 0 for its default of 50 us."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(PR_SET_TIMERSLACK, nanoseconds)
