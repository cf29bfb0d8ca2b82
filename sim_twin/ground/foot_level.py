"""Estimates the height of the ground under the stance foot from joint angles and contacts."""

import mujoco
import numpy as np

from windup.hal.observation import Observation
from windup.robots.description import RobotDescription

SURE = 0.015
"""Heights below this share of the base's height count as 0: foot tilt or sinking fakes them."""


class FootLevel:
    """Estimates the ground height as the height of the lowest pressed contact sensor.

    Args:
        robot: The robot; each of its contact sensors has a site of the same name.

    Attributes:
        sure: Smallest height that is distinguished from 0, m.
    """

    def __init__(self, robot: RobotDescription) -> None:
        self.contacts = robot.contacts
        self.sure = SURE * float(robot.spec().body(robot.base).pos[2])
        self.model = robot.model
        self.data = mujoco.MjData(self.model)
        sites = [self.model.sensor(name).objid[0] for name in robot.contacts.names]
        self._sites = np.array(sites, dtype=np.intp)
        soles = {
            name: self.model.site(foot.site).pos[2] for foot in robot.feet for name in foot.sensors
        }
        above = [self.model.site_pos[s, 2] for s in sites]
        names = robot.contacts.names
        self._above = np.array([z - soles[n] for z, n in zip(above, names, strict=True)])

    def of(self, observation: Observation) -> float:
        """Return the height of the ground, m; 0 when it cannot be distinguished from 0."""
        base, pressed = observation.base, self.contacts.pressed(observation.contacts)
        if base is None or not pressed.any():
            return 0.0
        self.data.qpos[:3], self.data.qpos[3:7] = base.position, base.orientation
        self.data.qpos[7:] = observation.joints.position
        mujoco.mj_kinematics(self.model, self.data)
        heights = self.data.site_xpos[self._sites, 2] - self._above
        level = float(heights[pressed].min())
        return level if abs(level) > self.sure else 0.0
