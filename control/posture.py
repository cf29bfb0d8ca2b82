"""How a robot at rest is: on its feet or held in the air, sitting, or lying on one of its sides.

An accelerometer at rest shows the vertical; the encoders show how far the base is above the lowest
point of the soles. Whether the soles bear anything a limp robot does not feel: one that hangs in
somebody's hands is told as one that stands.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import acos
from typing import Literal

import numpy as np

from control.soles import Soles
from control.tilt_filter import GRAVITY
from hal.joints import Array
from hal.observation import Observation

Side = Literal["front", "back", "left side", "right side"]
UNSURE = 2.0
"""An accelerometer farther than this from gravity is not at rest, m/s2."""


@dataclass(frozen=True)
class Posture:
    """How a robot at rest is.

    Attributes:
        tilt: Of the base from upright, rad.
        side: The side that is down, where it lies.
        height: Of the base above the lowest point of the soles, m.
    """

    tilt: float
    side: Side
    height: float

    @classmethod
    def of(cls, soles: Soles, seen: Sequence[Observation]) -> "Posture | None":
        """Return the mean posture over some observations; None where nobody measures it.

        Args:
            soles: The robot's soles.
            seen: Observations of a robot at rest.
        """
        felt = [item.imu.acceleration for item in seen if item.imu is not None]
        if not felt:
            return None
        mean = np.mean(felt, axis=0)
        size = float(np.linalg.norm(mean))
        if abs(size - GRAVITY) > UNSURE:
            return None
        up = mean / size
        position = seen[-1].joints.position
        soles.update(position, np.zeros_like(position), up)
        return cls(acos(min(max(float(up[2]), -1.0), 1.0)), _side(up), -float(soles.heights.min()))


def _side(up: Array) -> Side:
    """Return which side of the base points down the most, with the vertical (3,) as it sees it."""
    x, y, _ = up.tolist()
    if abs(x) >= abs(y):
        return "back" if x > 0.0 else "front"
    return "right side" if y > 0.0 else "left side"
