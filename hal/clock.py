"""The clock on the wall."""

import time


class WallClock:
    """Monotonic time; waiting sleeps."""

    def now(self) -> float:
        """Return the time since some moment in the past, s."""
        return time.monotonic()

    def wait_until(self, time_: float) -> None:
        """Sleep until it is `time_` s."""
        while (left := time_ - time.monotonic()) > 0.0:
            time.sleep(left)
