"""An IMU that falls silent, freezes, or feels a spin that is not there."""

import math

import numpy as np

from windup.hal.joints import Array
from windup.sim_twin.wire.imu.imu import ImuSource
from windup.sim_twin.wire.schedule import Schedule


class FaultyImu:
    """What can go wrong with an IMU, between the motion that it feels and who reports it.

    Frozen, it gives the sample of that moment again and again, bit for bit. Spinning, its gyroscope
    reads a constant rate about x whatever the body does, and the attitude that is made of it turns
    with that rate. Frozen and spinning, it is frozen.

    Args:
        source: The motion.
        schedule: The world's, for its time.
    """

    def __init__(self, source: ImuSource, schedule: Schedule) -> None:
        self._source, self._schedule = source, schedule
        self._silent = self._frozen = self._spinning = -math.inf  # until when, s
        self._kept: tuple[Array, Array, Array] = (np.zeros(3), np.zeros(3), np.zeros(4))
        self._since = self._speed = 0.0

    def fall_silent(self, seconds: float) -> None:
        """Report nothing for some seconds."""
        self._silent = self._schedule.now + seconds

    def freeze(self, seconds: float) -> None:
        """Report the present sample for some seconds."""
        kept = self.angular_velocity, self.acceleration, self.orientation
        self._kept = kept[0].copy(), kept[1].copy(), kept[2].copy()
        self._frozen = self._schedule.now + seconds

    def spin(self, seconds: float, speed: float) -> None:
        """Report `speed` rad/s about x for some seconds."""
        self._since, self._speed = self._schedule.now, speed
        self._spinning = self._since + seconds

    @property
    def silent(self) -> bool:
        """Whether it reports nothing now."""
        return self._source.silent or self._schedule.now < self._silent

    @property
    def angular_velocity(self) -> Array:
        """(3,) rad/s."""
        if self._schedule.now < self._frozen:
            return self._kept[0]
        felt = self._source.angular_velocity
        return np.array([self._speed, *felt[1:]]) if self._turns else felt

    @property
    def acceleration(self) -> Array:
        """(3,) m/s2."""
        frozen = self._schedule.now < self._frozen
        return self._kept[1] if frozen else self._source.acceleration

    @property
    def orientation(self) -> Array:
        """(4,) wxyz, body to world."""
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
