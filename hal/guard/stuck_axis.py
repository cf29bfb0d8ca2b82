"""Detects a gyroscope axis that is stuck at a high rate while the rest of the IMU still changes.

A body that turns fast never turns at exactly the same rate for long: if a rate is repeated bit
for bit while other values change, the sensor is stuck at that value, such as the end of its
range.
"""

from collections.abc import Sequence

from windup.hal.guard.finding import AGAIN, FindingText

FAST = 0.7
"""Minimum rate that counts as stuck, rad/s: a body at rest repeats zero."""
MIN_DURATION = 0.1
"""Minimum time for which a rate is repeated, s."""
MIN_SAMPLES = 8
"""Minimum number of samples that repeat a rate: few arrive within `MIN_DURATION` if the host
is busy."""

ONE_AXIS = FindingText(
    "imu spinning",
    "repeating a rate of {:.1f} rad/s about one axis",
    "above {:.1f}",
    AGAIN,
    1.0,
    "the IMU",
)


class StuckAxis:
    """Counts how often each of the three angular rates is repeated in new samples."""

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """Reset; counting starts with the next sample."""
        self._last: Sequence[float] = ()
        self._since, self._count = [0.0] * 3, [0] * 3

    def update(
        self, sample: Sequence[float], now: float
    ) -> tuple[FindingText, float, float] | None:
        """Return (text, rate, limit) if an axis is stuck in a new (6,) sample, else None.

        The first three values are the angular rates, rad/s.
        """
        stuck = None
        for axis in range(3):
            rate = sample[axis]
            if not self._last or rate != self._last[axis] or abs(rate) < FAST:
                self._since[axis], self._count[axis] = now, 0
                continue
            self._count[axis] += 1
            if self._count[axis] >= MIN_SAMPLES and now - self._since[axis] >= MIN_DURATION:
                stuck = ONE_AXIS, abs(rate), FAST
        self._last = sample
        return stuck
