"""How a robot at rest is: on its feet or held in the air, sitting, or lying on one of its sides.

An accelerometer at rest shows the vertical; the encoders show what is lowest: the feet, or
something else. Whether the feet bear anything a limp robot does not feel: one that hangs in
somebody's hands is told as one that stands.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import acos
from typing import Literal

import mujoco
import numpy as np

from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array
from windup.hal.observation import Observation

Side = Literal["front", "back", "left side", "right side"]
UNSURE = 2.0
"""An accelerometer farther than this from gravity is not at rest, m/s2."""


@dataclass(frozen=True)
class Posture:
    """How a robot at rest is.

    Attributes:
        tilt: Of the base from upright, rad.
        side: The side that is down, where it lies.
        height: Of the base above the lowest point of the feet, m.
        clearance: Of everything but the feet above the same point, m.
    """

    tilt: float
    side: Side
    height: float
    clearance: float


class PostureSense:
    """Tells how one robot is.

    Args:
        model: The robot alone: a free joint, then n hinges in MJCF order.
        feet: Names of the feet's bodies.
    """

    def __init__(self, model: mujoco.MjModel, feet: Sequence[str]) -> None:
        self._model, self._data = model, mujoco.MjData(model)
        solid = (model.geom_contype > 0) | (model.geom_conaffinity > 0)
        self._geoms = np.flatnonzero(solid & (model.geom_bodyid > 0))
        self._of_feet = np.isin(model.geom_bodyid[self._geoms], [model.body(f).id for f in feet])
        # Boxes around the geoms, in their frames.
        self._centre = model.geom_aabb[self._geoms, :3]
        self._size = model.geom_aabb[self._geoms, 3:]

    def posture(self, seen: Sequence[Observation]) -> Posture | None:
        """Return the mean posture over some observations at rest; None where it is not known."""
        felt = [item.imu.acceleration for item in seen if item.imu is not None]
        if not felt:
            return None
        mean = np.mean(felt, axis=0)
        size = float(np.linalg.norm(mean))
        if abs(size - GRAVITY) > UNSURE:
            return None
        up = mean / size
        feet, others = self.lowest(seen[-1].joints.position, up)
        tilt = acos(min(max(float(up[2]), -1.0), 1.0))
        return Posture(tilt, _side(up), -feet, others - feet)

    def lowest(self, position: Array, up: Array) -> tuple[float, float]:
        """Return how high above the base's origin the lowest foot is, and all else, m.

        Args:
            position: (n,) rad.
            up: (3,) the vertical as the base sees it.
        """
        data = self._data
        data.qpos[:7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
        data.qpos[7:] = position
        mujoco.mj_kinematics(self._model, data)
        vertical = up @ data.geom_xmat[self._geoms].reshape(-1, 3, 3)
        heights = data.geom_xpos[self._geoms] @ up + (vertical * self._centre).sum(axis=1)
        heights -= (np.abs(vertical) * self._size).sum(axis=1)
        return float(heights[self._of_feet].min()), float(heights[~self._of_feet].min())


def _side(up: Array) -> Side:
    """Return which side of the base points down the most, with the vertical (3,) as it sees it."""
    x, y, _ = up.tolist()
    if abs(x) >= abs(y):
        return "back" if x > 0.0 else "front"
    return "right side" if y > 0.0 else "left side"
