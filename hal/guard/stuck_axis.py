"""Is one axis of a gyroscope stuck at a high rate while the rest of the IMU goes on?

A body that turns fast never turns at exactly the same rate for long: a rate that is repeated bit
for bit, beside other values that change, is a number that the sensor is stuck at, such as the end
of its range.
"""

from collections.abc import Sequence

from windup.hal.guard.finding import AGAIN, Saying

FAST = 0.7
"""A slower rate may be repeated: a body at rest reads zero again and again, rad/s."""
PERSIST = 0.1
"""For how long it has to be repeated, s; with 1 degree/s to a count, a walk does so for 0.03 s."""
SAMPLES = 8
"""By so many new samples: on a busy machine few come within that time."""

ONE_AXIS = Saying(
    "imu spinning", "stuck about one axis, at {:.1f} rad/s", "above {:.1f}", AGAIN, 1.0, "the IMU"
)


class StuckAxis:
    """Counts how often each of the three rates of new samples has been repeated."""

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """Begin anew with the next sample."""
        self._last: Sequence[float] = ()
        self._since, self._count = [0.0] * 3, [0] * 3

    def update(self, sample: Sequence[float], now: float) -> tuple[Saying, float, float] | None:
        """Return what is wrong with a new sample: (6,), its rates come first, rad/s."""
        for axis in range(3):
            rate = sample[axis]
            if not self._last or rate != self._last[axis] or abs(rate) < FAST:
                self._since[axis], self._count[axis] = now, 0
                continue
            self._count[axis] += 1
            if self._count[axis] >= SAMPLES and now - self._since[axis] >= PERSIST:
                return ONE_AXIS, abs(rate), FAST
        self._last = sample
        return None
