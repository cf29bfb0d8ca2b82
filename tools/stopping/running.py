"""Tracks whether a run is in progress and in which thread, and ends it from another thread."""

import threading
from types import TracebackType

from windup.hal.errors import UsageError

STOP_TIME = 3.0
"""Longest time for a run to react to a request and to stop its robot, s."""


class Running:
    """A context that is active during a run; only one run is possible at a time.

    Attributes:
        requested_by: Name of the request to end the run; "" if there is none.
    """

    def __init__(self) -> None:
        self.requested_by = ""
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._idle = threading.Event()
        self._idle.set()

    def __enter__(self) -> None:
        """Begin a run.

        Raises:
            UsageError: Another run is in progress.
        """
        if not self._lock.acquire(blocking=False):
            raise UsageError(
                "this robot is already running: wait for the end of the run, or call stop()"
            )
        self.requested_by = ""
        self._thread = threading.current_thread()
        self._idle.clear()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._thread = None
        self._idle.set()
        self._lock.release()

    @property
    def active(self) -> bool:
        """True while a run is in progress, in whichever thread."""
        return self._thread is not None

    def end(self, by: str) -> threading.Thread | None:
        """Request the end of the run at its next tick; return its thread, or None without a run."""
        thread = self._thread
        if thread is not None:
            self.requested_by = self.requested_by or by
        return thread

    def end_and_wait(self, by: str) -> bool:
        """End the run and wait for that; return False if there is none, or it hangs."""
        thread = self.end(by)
        if thread is None:
            return False
        return thread is threading.current_thread() or self._idle.wait(STOP_TIME)
