"""Complementary filter for height and vertical velocity, from accelerometer and soles.

The ground under a foot yields by millimetres at each impact, so a still sole is a good reference
for horizontal motion and a bad one for vertical motion; its mean height over the floor is good.
A second-order observer with natural frequency w fuses both::

    dz / dt = v + 2 d w (h - z)    dv / dt = a + w^2 (h - z) + c    dc / dt = w^2 (h - z) / T

The correction c compensates the accelerometer's error, including that by a tilt error at rest.
"""

FREQUENCY = 10.0
"""Natural frequency w, rad/s."""
DAMPING = 0.7
"""Damping ratio d."""
LEARNING = 1.0
"""Time constant T of the correction, s."""


class HeightFilter:
    """Observer of height and vertical velocity.

    Attributes:
        height: Estimated height z, m; None before the first measurement.
    """

    def __init__(self) -> None:
        self.height: float | None = None
        self._correction = 0.0

    def measure(self, height: float, velocity: float, dt: float) -> float:
        """Return the corrected vertical velocity, m/s.

        Args:
            height: Height h by the soles, m.
            velocity: Vertical velocity integrated from the accelerometer, m/s.
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
        """Return the height, m, without foot contact: integrated, and at least `lowest`.

        Args:
            lowest: Height at which the lowest point of the soles is on the floor, m.
            velocity: Vertical velocity, m/s.
            dt: Time since the last call, s.
        """
        before = lowest if self.height is None else self.height
        self.height = max(lowest, before + velocity * dt)
        return self.height
