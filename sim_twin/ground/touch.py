"""Records which bodies of a twin touch the ground other than its feet."""

import mujoco
import numpy as np

from windup.robots.description import RobotDescription


class TouchWatch:
    """Records the bodies, other than feet, that have touched the ground.

    Args:
        robot: The robot.
        model: The model of its twin.
        data: The state of its twin.
        feet: Names of the bodies that are allowed to touch; by default the robot's feet.

    Attributes:
        touched: Names of the other bodies that touched, in order of first touch.
    """

    def __init__(
        self,
        robot: RobotDescription,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        feet: list[str] | None = None,
    ) -> None:
        self._model, self._data = model, data
        names = [foot.body for foot in robot.feet] if feet is None else feet
        self._feet = {model.body(name).id for name in names}
        self.touched: list[str] = []

    def update(self) -> None:
        """Record the bodies that touch the ground now."""
        count = self._data.ncon
        if not count:
            return
        bodies = self._model.geom_bodyid[self._data.contact.geom[:count]]
        grounded = bodies[(bodies == 0).any(axis=1)]
        for body in np.unique(grounded.max(axis=1)).tolist():
            name = self._model.body(body).name
            if body and body not in self._feet and name not in self.touched:
                self.touched.append(name)
