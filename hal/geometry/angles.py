"""Angles modulo a full turn."""

from math import pi
from typing import TypeVar

import numpy as np
import numpy.typing as npt

Angle = TypeVar("Angle", float, npt.NDArray[np.float64])


def wrapped(angle: Angle) -> Angle:
    """Return an angle, or angles (...,), between -pi and pi rad.

    >>> wrapped(0.5), round(wrapped(2.0 * pi - 0.5), 12)
    (0.5, -0.5)
    """
    return (angle + pi) % (2.0 * pi) - pi
