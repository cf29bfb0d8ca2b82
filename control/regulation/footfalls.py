"""Estimation of the ground plane from the points where the feet have touched it."""

from collections import deque
from dataclasses import dataclass, field

import mujoco
import numpy as np

from windup.control.kinematics.robot_state import RobotState
from windup.hal.contacts import ContactSensors
from windup.hal.controller import Plane
from windup.hal.joints import Array
from windup.hal.observation import Observation

NOISE = 0.004
"""Standard deviation of a contact point from the plane, m."""
PRIOR = 0.1
"""Prior standard deviation of the slope; regularises the fit for feet side by side."""
FADE = 0.4
"""Weight of the points of a step, relative to those of the step after it."""
SLIGHT = 0.006
"""A smaller slope, or height in m on level ground, is taken as 0."""


@dataclass
class Footfalls:
    """Fits a plane to the last contact points of the feet with the ground.

    Attributes:
        state: The robot's state.
        contacts: Its contact sensors, each with a site.
        count: Number of steps whose points are used.
    """

    state: RobotState
    contacts: ContactSensors
    count: int
    _steps: deque[list[Array]] = field(init=False)

    def __post_init__(self) -> None:
        model, names = self.state.model, self.contacts.names
        self._sites = np.array([model.sensor(name).objid[0] for name in names], dtype=np.intp)
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        foot = self.contacts.members.argmax(axis=0)
        self._above = data.site_xpos[self._sites, 2] - data.site_xpos[self.state.sites[foot], 2]
        self.reset()

    def reset(self) -> None:
        """Discard all points."""
        self._steps = deque([[]], maxlen=self.count)

    def see(self, observation: Observation) -> None:
        """Add the points in contact."""
        pressed = self.contacts.pressed(observation.contacts)
        points = self.state.update(observation).points(self._sites)[pressed]
        points[:, 2] -= self._above[pressed]
        self._steps[-1] += list(points)

    def end_step(self) -> None:
        """Begin a new step; the points of earlier ones lose weight."""
        self._steps.append([])

    def plane(self) -> Plane:
        """Return the ground plane: height at the origin, m, and slopes along x and y."""
        points = np.array([point for step in self._steps for point in step]).reshape(-1, 3)
        if not len(points):
            return (0.0, 0.0, 0.0)
        ages = np.repeat(np.arange(len(self._steps))[::-1], [len(step) for step in self._steps])
        weights = FADE ** (ages - ages.min())
        centre = weights @ points / weights.sum()
        flat, height = (points - centre)[:, :2], (points - centre)[:, 2]
        normal = (flat.T * weights) @ flat + (NOISE / PRIOR) ** 2 * np.eye(2)
        slope = np.linalg.solve(normal, (flat.T * weights) @ height)
        a, b = slope if float(np.hypot(*slope)) > SLIGHT else np.zeros(2)
        level = float(centre[2] - a * centre[0] - b * centre[1])
        if not (a or b) and abs(level) < SLIGHT:
            level = 0.0
        return level, float(a), float(b)
