"""IMU faults: silence, frozen samples, and a spurious rotation."""

import math

import numpy as np

from windup.hal.joints import Array
from windup.sim_twin.wire.imu.imu import ImuSource
from windup.sim_twin.wire.schedule import Schedule


class FaultyImu:
    """Adds faults to an IMU, between its motion source and the device that reports it.

    Frozen, it repeats the sample of that moment bit for bit. Spinning, its gyroscope reads a
    constant rate about x whatever the body does, and the reported attitude rotates at that rate.
    Frozen takes precedence over spinning.

    Args:
        source: Source of the motion.
        schedule: Schedule of the world, for its time.
    """

    def __init__(self, source: ImuSource, schedule: Schedule) -> None:
        self._source, self._schedule = source, schedule
        self._silent = self._frozen = self._spinning = -math.inf  # end of each fault, s
        self._kept: tuple[Array, Array, Array] = (np.zeros(3), np.zeros(3), np.zeros(4))
        self._since = self._speed = 0.0

    def fall_silent(self, seconds: float) -> None:
        """Report nothing for `seconds`."""
        self._silent = self._schedule.now + seconds

    def freeze(self, seconds: float) -> None:
        """Repeat the present sample for `seconds`."""
        kept = self.angular_velocity, self.acceleration, self.orientation
        self._kept = kept[0].copy(), kept[1].copy(), kept[2].copy()
        self._frozen = self._schedule.now + seconds

    def spin(self, seconds: float, speed: float) -> None:
        """Report `speed` rad/s about x for `seconds`."""
        self._since, self._speed = self._schedule.now, speed
        self._spinning = self._since + seconds

    @property
    def silent(self) -> bool:
        """Whether the IMU reports nothing now."""
        return self._source.silent or self._schedule.now < self._silent

    @property
    def angular_velocity(self) -> Array:
        """Angular velocity (3,), rad/s."""
        if self._schedule.now < self._frozen:
            return self._kept[0]
        felt = self._source.angular_velocity
        return np.array([self._speed, *felt[1:]]) if self._turns else felt

    @property
    def acceleration(self) -> Array:
        """Proper acceleration (3,), m/s2."""
        frozen = self._schedule.now < self._frozen
        return self._kept[1] if frozen else self._source.acceleration

    @property
    def orientation(self) -> Array:
        """Orientation (4,), wxyz quaternion from body to world."""
        if self._schedule.now < self._frozen:
            return self._kept[2]
        felt = self._source.orientation
        if not self._turns:
            return felt
        half = 0.5 * self._speed * (self._schedule.now - self._since)
        cos, sin = math.cos(half), math.sin(half)
        w, x, y, z = felt
        return np.array(
            [w * cos - x * sin, x * cos + w * sin, y * cos + z * sin, z * cos - y * sin]
        )

    @property
    def _turns(self) -> bool:
        return self._schedule.now < self._spinning
