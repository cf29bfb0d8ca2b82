"""How close the feet come to each other, whether or not they collide in the twin."""

import mujoco
import numpy as np

from windup.robots.description import RobotDescription


class FootClearance:
    """The distance between the two feet of a robot; negative when they pass through each other.

    A foot is the largest of its geoms: the sole, or the shoe.

    Args:
        robot: The robot.
        model: The model of its twin.
        data: The state of its twin.

    Attributes:
        smallest: The smallest distance so far, m.
    """

    REACH = 0.5  # farther apart than this is far enough, m

    def __init__(self, robot: RobotDescription, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.model, self.data = model, data
        self._geoms = [_largest(model, foot.body) for foot in robot.feet]
        self.smallest = float("inf")

    def update(self) -> float:
        """Measure now, and return the distance, m."""
        left, right = self._geoms[:2]
        found = mujoco.mj_geomDistance(self.model, self.data, left, right, self.REACH, None)
        self.smallest = min(self.smallest, float(found))
        return float(found)


def _largest(model: mujoco.MjModel, body: str) -> int:
    """Return the id of the largest geom of a body."""
    geoms = np.flatnonzero(model.geom_bodyid == model.body(body).id)
    return int(geoms[np.argmax(model.geom_rbound[geoms])])
