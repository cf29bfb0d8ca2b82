"""Height and vertical velocity: the accelerometer in the short run, the soles in the long one.

The ground under a foot gives way by millimetres at each impact, so a sole that stands still is a
good witness of horizontal motion and a bad one of vertical motion. Its height over the floor is
good in the mean. A second-order observer with natural frequency w joins both::

    dz / dt = v + 2 d w (h - z)    dv / dt = a + w^2 (h - z) + c    dc / dt = w^2 (h - z) / T

The correction c is what the accelerometer is wrong by, and the tilt of a still robot adds to it.
"""

FREQUENCY = 10.0
"""w, rad/s."""
DAMPING = 0.7
"""d."""
LEARNING = 1.0
"""T, s."""


class HeightFilter:
    """Follows the height that the soles say, with the accelerometer's quickness.

    Attributes:
        height: m; None before the first measurement.
    """

    def __init__(self) -> None:
        self.height: float | None = None
        self._correction = 0.0

    def measure(self, height: float, velocity: float, dt: float) -> float:
        """Return the corrected vertical velocity, m/s.

        Args:
            height: What the soles say, m.
            velocity: What the accelerometer has integrated to, m/s.
            dt: Time since the last measurement, s.
        """
        if self.height is None:
            self.height = height
        error = height - self.height
        self.height += (velocity + 2.0 * DAMPING * FREQUENCY * error) * dt
        pull = FREQUENCY**2 * error
        self._correction += pull * dt / LEARNING
        return velocity + (pull + self._correction) * dt

    def fly(self, lowest: float, velocity: float, dt: float) -> float:
        """Return the height, m, of a robot with no foot down; no sole is under the floor."""
        before = lowest if self.height is None else self.height
        self.height = max(lowest, before + velocity * dt)
        return self.height
