"""Determines when the activity of a program begins, and when its fault is due."""

import time
from math import inf
from multiprocessing.connection import Connection


class FaultTimer:
    """The beginning of the activity, and the time at which the fault is due.

    Args:
        tell: Connection to the process that observes the program.
        after: Time from the beginning to the fault, s.
    """

    def __init__(self, tell: Connection, after: float) -> None:
        self._tell, self._after = tell, after
        self._at = inf
        self._told = False

    def now(self, activity: str) -> None:
        """Report that the activity has begun; later calls have no effect."""
        if self._at == inf:
            self._at = time.monotonic() + self._after
            self._tell.send(("doing", activity))

    def due(self) -> bool:
        """Return whether the fault is due; report it the first time."""
        if time.monotonic() < self._at:
            return False
        if not self._told:
            self._told = True
            self._tell.send(("fault", time.monotonic()))
        return True
