"""Distance between the feet, whether or not they collide in the twin."""

import mujoco
import numpy as np

from windup.robots.description import RobotDescription


class FootClearance:
    """Measures the distance between a robot's two feet; negative when they interpenetrate.

    Each foot is represented by the largest of its geoms: the sole, or the shoe.

    Args:
        robot: The robot.
        model: The model of its twin.
        data: The state of its twin.

    Attributes:
        smallest: Smallest distance so far, m.
    """

    REACH = 0.5  # distances above this are not measured, m

    def __init__(self, robot: RobotDescription, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.model, self.data = model, data
        self._geoms = [_largest(model, foot.body) for foot in robot.feet]
        self.smallest = float("inf")

    def update(self) -> float:
        """Measure the present distance, m, and return it."""
        left, right = self._geoms[:2]
        found = mujoco.mj_geomDistance(self.model, self.data, left, right, self.REACH, None)
        self.smallest = min(self.smallest, float(found))
        return float(found)


def _largest(model: mujoco.MjModel, body: str) -> int:
    """Return the id of the largest geom of a body."""
    geoms = np.flatnonzero(model.geom_bodyid == model.body(body).id)
    return int(geoms[np.argmax(model.geom_rbound[geoms])])
