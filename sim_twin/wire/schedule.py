"""A schedule of future actions, in order of time."""

import heapq
import math
from collections.abc import Callable


class Schedule:
    """A queue of actions with their times; equal times keep their order.

    Attributes:
        now: Time of the present action, or to which the world has advanced, s.
    """

    def __init__(self) -> None:
        self.now = 0.0
        self._queue: list[tuple[float, int, Callable[[], object]]] = []
        self._count = 0

    @property
    def next(self) -> float:
        """Time of the next action, s; infinity if there is none."""
        return self._queue[0][0] if self._queue else math.inf

    def add(self, time: float, action: Callable[[], object]) -> None:
        """Schedule `action` for `time`, s, or for now if that has passed."""
        self._count += 1
        heapq.heappush(self._queue, (max(time, self.now), self._count, action))

    def clear(self) -> None:
        """Remove all actions."""
        self._queue.clear()

    def run_next(self) -> None:
        """Advance the time to the next action and execute it."""
        time, _, action = heapq.heappop(self._queue)
        self.now = max(self.now, time)
        action()
