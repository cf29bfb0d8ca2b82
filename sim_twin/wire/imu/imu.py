"""Sources of the motion that an emulated IMU measures."""

from typing import Protocol

import numpy as np

from windup.hal.joints import Array

GRAVITY = 9.80665  # m/s2


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
    acceleration: Array = np.array([0.0, 0.0, GRAVITY])
    orientation: Array = np.array([1.0, 0.0, 0.0, 0.0])
