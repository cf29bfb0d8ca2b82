"""Whether a run is going on, in which thread, and a way to end it from another one."""

import threading
from types import TracebackType

PATIENCE = 3.0
"""What a run may take to see that it shall end, and to stop its robot, s."""


class Running:
    """A context for the time of a run.

    Attributes:
        asked: Another thread wants the run to end.
    """

    def __init__(self) -> None:
        self.asked = False
        self._thread: threading.Thread | None = None
        self._idle = threading.Event()
        self._idle.set()

    def __bool__(self) -> bool:
        """Return whether a run is going on."""
        return self._thread is not None

    def __enter__(self) -> None:
        self.asked = False
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

    def end_from_elsewhere(self) -> bool:
        """End a run of another thread and wait for that; False where there is none, or it hangs."""
        if self._thread is None or self._thread is threading.current_thread():
            return False
        self.asked = True
        return self._idle.wait(PATIENCE)
