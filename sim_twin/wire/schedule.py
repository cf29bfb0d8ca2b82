"""Things that will happen, in order of time."""

import heapq
import math
from collections.abc import Callable


class Schedule:
    """A queue of actions, each with its time; equal times keep their order.

    Attributes:
        now: Time of the action that runs, or that the world has been brought to, s.
    """

    def __init__(self) -> None:
        self.now = 0.0
        self._queue: list[tuple[float, int, Callable[[], object]]] = []
        self._count = 0

    @property
    def next(self) -> float:
        """When the next action is due, s; infinity if there is none."""
        return self._queue[0][0] if self._queue else math.inf

    def at(self, time: float, action: Callable[[], object]) -> None:
        """Have `action` called at `time` s; now, if that has passed."""
        self._count += 1
        heapq.heappush(self._queue, (max(time, self.now), self._count, action))

    def clear(self) -> None:
        """Let nothing happen any more."""
        self._queue.clear()

    def run_next(self) -> None:
        """Bring time to the next action and do it."""
        time, _, action = heapq.heappop(self._queue)
        self.now = max(self.now, time)
        action()
