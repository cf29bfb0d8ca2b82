"""Orientation of an IMU in the body, in quarter turns."""

from functools import cached_property

import numpy as np

from windup.hal.errors import ConfigError
from windup.hal.joints import Array

Axes = tuple[str, str, str]
STRAIGHT: Axes = ("x", "y", "z")
AXIS_NAMES = ("x", "y", "z", "-x", "-y", "-z")


class Mounting:
    """Rotates vectors between the frame of an IMU and the body frame.

    Args:
        axes: The axes of the IMU that point along the body's x (forward), y (left) and z (up):
            ("-y", "x", "z") is a board whose y axis points backward and whose x axis points left.

    Attributes:
        axes: As given.

    Raises:
        ConfigError: A word is no axis, an axis is named twice, or the axes are left-handed.
    """

    def __init__(self, axes: Axes = STRAIGHT) -> None:
        for word in axes:
            if word not in AXIS_NAMES:
                raise ConfigError(f"{word!r} is no axis; known: {', '.join(AXIS_NAMES)}")
        self.axes = axes
        self._from = np.array(["xyz".index(word[-1]) for word in axes])
        self._signs = np.array([-1.0 if word[0] == "-" else 1.0 for word in axes])
        if len(set(self._from.tolist())) < 3:
            raise ConfigError(f"{', '.join(axes)} names an axis twice")
        if np.linalg.det(self._matrix) < 0.0:
            raise ConfigError(
                f"{', '.join(axes)} is left-handed, and no board is: change the sign of one axis"
            )

    def to_body(self, vector: Array) -> Array:
        """Return a vector (3,) of the IMU frame in the body frame."""
        return vector[self._from] * self._signs

    def to_imu(self, vector: Array) -> Array:
        """Return a vector (3,) of the body frame in the IMU frame."""
        turned = np.empty(3)
        turned[self._from] = vector * self._signs
        return turned

    @property
    def _matrix(self) -> Array:
        matrix = np.zeros((3, 3))
        matrix[np.arange(3), self._from] = self._signs
        return matrix

    @cached_property
    def quaternion(self) -> Array:
        """(4,) wxyz, IMU to body."""
        if self.axes == STRAIGHT:
            return np.array([1.0, 0.0, 0.0, 0.0])
        from scipy.spatial.transform import Rotation  # slow to import, and rarely needed

        return np.asarray(Rotation.from_matrix(self._matrix).as_quat(scalar_first=True))
