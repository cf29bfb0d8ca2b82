"""Tries a controller on one observation of a twin, before anything moves."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from windup.control.returned import no_command
from windup.hal.command import FIELDS, JointCommand
from windup.hal.controller import Controller
from windup.robots import RobotDescription
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.twin import Twin


@dataclass(frozen=True)
class Returned:
    """What a controller returned.

    Attributes:
        value: The value.
        robot: The robot that it is for.
    """

    value: Any
    robot: RobotDescription

    def problem(self) -> str:
        """Return what is wrong with it as a command, after "step"; "" if nothing is."""
        joints = self.robot.joints
        if not isinstance(self.value, JointCommand):
            return no_command(self.value)
        block, shape = self.value.block, (len(FIELDS), len(joints))
        if block.shape != shape:
            return (
                f"returned a command of shape {block.shape} for the {len(joints)} joints of "
                f"{self.robot.name}; it should be {shape}"
            )
        bad = np.argwhere(~np.isfinite(block))
        if bad.size:
            row, joint = bad[0]
            return (
                f"commanded {FIELDS[row]} {block[row, joint]} for joint {joints.names[joint]!r}; "
                "give finite values"
            )
        return ""


def try_out(controller: Controller, robot: RobotDescription) -> Returned:
    """Return what a controller returns for a twin that stands in its stance."""
    twin = Twin(robot)
    twin.reset()
    observation = TwinBackend(twin).read()
    controller.reset(observation)
    return Returned(controller.step(observation, 1.0 / robot.rate_hz), robot)
