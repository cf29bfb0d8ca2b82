"""Sources of the motion that an emulated IMU measures."""

from typing import Protocol

import numpy as np

from windup.hal.geometry.gravity import STANDARD_GRAVITY
from windup.hal.geometry.quaternion import multiply
from windup.hal.imu.mounting import Mounting
from windup.hal.joints import Array


class ImuSource(Protocol):
    """Motion that an IMU reports, in the body frame."""

    @property
    def silent(self) -> bool:
        """Whether the IMU reports nothing now."""
        ...

    @property
    def angular_velocity(self) -> Array:
        """Angular velocity (3,), rad/s."""
        ...

    @property
    def acceleration(self) -> Array:
        """Proper acceleration (3,), m/s2; +9.81 upward at rest."""
        ...

    @property
    def orientation(self) -> Array:
        """Orientation (4,), wxyz quaternion from body to world."""
        ...


class RestingImu:
    """An IMU at rest, level on the bench."""

    silent = False
    angular_velocity: Array = np.zeros(3)
    acceleration: Array = np.array([0.0, 0.0, STANDARD_GRAVITY])
    orientation: Array = np.array([1.0, 0.0, 0.0, 0.0])


class MountedImu:
    """A source in the frame of an IMU whose axes differ from those of the body.

    Args:
        source: The motion in the body frame.
        mounting: Orientation of the IMU in the body.
    """

    def __init__(self, source: ImuSource, mounting: Mounting) -> None:
        self._source, self._mounting = source, mounting

    @property
    def silent(self) -> bool:
        """Whether it reports nothing now."""
        return self._source.silent

    @property
    def angular_velocity(self) -> Array:
        """(3,) rad/s."""
        return self._mounting.to_imu(self._source.angular_velocity)

    @property
    def acceleration(self) -> Array:
        """(3,) m/s2."""
        return self._mounting.to_imu(self._source.acceleration)

    @property
    def orientation(self) -> Array:
        """(4,) wxyz, IMU to world."""
        return multiply(self._source.orientation, self._mounting.quaternion)
