"""When the activity of a program has begun, and when its fault is due."""

import time
from math import inf
from multiprocessing.connection import Connection


class Begin:
    """When the activity has begun, and when the fault is due.

    Args:
        tell: To whoever watches the program.
        after: From the one to the other, s.
    """

    def __init__(self, tell: Connection, after: float) -> None:
        self._tell, self._after = tell, after
        self._at = inf
        self._told = False

    def now(self, activity: str) -> None:
        """Say that the activity has begun; again is no matter."""
        if self._at == inf:
            self._at = time.monotonic() + self._after
            self._tell.send(("doing", activity))

    def due(self) -> bool:
        """Return whether it is time for the fault; says so the first time."""
        if time.monotonic() < self._at:
            return False
        if not self._told:
            self._told = True
            self._tell.send(("fault", time.monotonic()))
        return True
