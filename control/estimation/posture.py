"""Posture of a robot at rest: on its feet or held in the air, sitting, or lying on a side.

An accelerometer at rest gives the vertical; the encoders give what is lowest: the feet, or another
part. Foot load is not measured: a robot that hangs in somebody's hands cannot be told from one
that stands.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import acos, inf
from typing import Literal

import mujoco
import numpy as np

from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array
from windup.hal.observation import Observation

Side = Literal["front", "back", "left side", "right side"]
UNSURE = 2.0
"""Maximum deviation of an accelerometer at rest from gravity, m/s2."""


@dataclass(frozen=True)
class Posture:
    """Posture of a robot at rest.

    Attributes:
        tilt: Tilt of the base from upright, rad.
        side: The side of the base that faces down the most.
        height: Height of the base above the lowest point of the feet, m; infinite where the feet
            do not collide.
        clearance: Height of the lowest point of all other bodies above the same point, m; infinite
            where nothing but the feet collides.
    """

    tilt: float
    side: Side
    height: float
    clearance: float


class PostureSense:
    """Measures the posture of one robot.

    Args:
        model: The robot alone: a free joint, then n hinges in MJCF order.
        feet: Names of the feet's bodies.
    """

    def __init__(self, model: mujoco.MjModel, feet: Sequence[str]) -> None:
        self._model, self._data = model, mujoco.MjData(model)
        solid = (model.geom_contype > 0) | (model.geom_conaffinity > 0)
        self._geoms = np.flatnonzero(solid & (model.geom_bodyid > 0))
        self._of_feet = np.isin(model.geom_bodyid[self._geoms], [model.body(f).id for f in feet])
        # Bounding boxes of the geoms, in their frames.
        self._centre = model.geom_aabb[self._geoms, :3]
        self._size = model.geom_aabb[self._geoms, 3:]

    def posture(self, seen: Sequence[Observation]) -> Posture | None:
        """Return the mean posture over some observations; None without an IMU or not at rest."""
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
        """Return the heights above the base's origin of the lowest points of feet and others, m.

        Only geoms that collide count. Without any, the feet are at minus infinity, and all others
        at plus infinity: then no height tells how the robot is, but its tilt does.

        Args:
            position: (n,) joint positions, rad.
            up: (3,) vertical in the base frame.
        """
        data = self._data
        data.qpos[:7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
        data.qpos[7:] = position
        mujoco.mj_kinematics(self._model, data)
        vertical = up @ data.geom_xmat[self._geoms].reshape(-1, 3, 3)
        heights = data.geom_xpos[self._geoms] @ up + (vertical * self._centre).sum(axis=1)
        heights -= (np.abs(vertical) * self._size).sum(axis=1)
        feet, others = heights[self._of_feet], heights[~self._of_feet]
        return float(feet.min()) if len(feet) else -inf, float(others.min(initial=inf))


def _side(up: Array) -> Side:
    """Return the side of the base that faces down the most, for the vertical (3,) in its frame."""
    x, y, _ = up.tolist()
    if abs(x) >= abs(y):
        return "back" if x > 0.0 else "front"
    return "right side" if y > 0.0 else "left side"
