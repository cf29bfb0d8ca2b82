"""Whether a run is going on, in which thread, and a way to end it from elsewhere."""

import threading
from types import TracebackType

from windup.hal.errors import UsageError

PATIENCE = 3.0
"""What a run may take to see that it shall end, and to stop its robot, s."""


class Running:
    """A context for the time of a run, of which there is one at a time.

    Attributes:
        asked: Who wants the run to end, in words; "" if nobody does.
    """

    def __init__(self) -> None:
        self.asked = ""
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._idle = threading.Event()
        self._idle.set()

    def __enter__(self) -> None:
        """Begin.

        Raises:
            UsageError: Another run is going on.
        """
        if not self._lock.acquire(blocking=False):
            raise UsageError("this robot is in a run already: wait until it is over, or stop() it")
        self.asked = ""
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

    def end(self, by: str) -> threading.Thread | None:
        """Have the run end at its next tick; return its thread, or None where there is no run."""
        thread = self._thread
        if thread is not None:
            self.asked = self.asked or by
        return thread

    def end_and_wait(self, by: str) -> bool:
        """End the run, and wait for that; False where there is none, or it hangs."""
        thread = self.end(by)
        if thread is None:
            return False
        return thread is threading.current_thread() or self._idle.wait(PATIENCE)
