"""Which way is up for a body that is tilted: its own z axis, in the world."""

from typing import Any

import numpy as np

from windup.hal.joints import Array

UP_AXIS = slice(2, None, 3)
"""Where the z axis of a body stands in its rotation matrix (9,), row by row."""


def up_axis(orientation: Array) -> Array:
    """Return the z axis (..., 3) in the world of what has orientations (..., 4) wxyz."""
    w, x, y, z = np.moveaxis(orientation, -1, 0)
    return np.stack([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), uprightness(x, y)], axis=-1)


def uprightness(x: Any, y: Any) -> Any:
    """Return the vertical component of that axis, from `x` and `y` of the quaternion.

    It is the cosine of the tilt.

    >>> uprightness(0.0, 0.0), uprightness(1.0, 0.0)
    (1.0, -1.0)
    """
    return 1.0 - 2.0 * (x * x + y * y)
