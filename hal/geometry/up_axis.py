"""The up axis of a body: its z axis in the world frame."""

from typing import Any

import numpy as np

from windup.hal.joints import Array

UP_AXIS = slice(2, None, 3)
"""Slice of the z axis of a body in its row-major rotation matrix (9,)."""


def up_axis(orientation: Array) -> Array:
    """Return the z axes (..., 3) in the world of bodies with orientations (..., 4) wxyz."""
    w, x, y, z = np.moveaxis(orientation, -1, 0)
    return np.stack([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), uprightness(x, y)], axis=-1)


def uprightness(x: Any, y: Any) -> Any:
    """Return the vertical component of that axis, the cosine of the tilt.

    `x` and `y` are components of the orientation wxyz.

    >>> uprightness(0.0, 0.0), uprightness(1.0, 0.0)
    (1.0, -1.0)
    """
    return 1.0 - 2.0 * (x * x + y * y)
