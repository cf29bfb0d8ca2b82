"""Putting together whole-body control of a robot with torque joints."""

from typing import Final

import numpy as np

from windup.control.execution.torque_executor import TorqueExecutor
from windup.control.kinematics.robot_state import RobotState
from windup.control.whole_body.dynamics import Dynamics
from windup.control.whole_body.whole_body import WholeBody
from windup.control.whole_body.whole_body_file import WholeBodyFile
from windup.hal.config import load_toml
from windup.hal.joints import Array
from windup.robots import RobotDescription
from windup.tools.assembly.state import state_of

WHOLE_BODY: Final = "whole_body.toml"
MOST: Final = 1e3
"""Maximum torque of a joint of a robot without the file, N m; its own limit holds as well."""


def find_whole_body(robot: RobotDescription) -> WholeBodyFile:
    """Return weights and gains of whole-body control; the defaults for a robot without the file.

    Raises:
        ConfigError: The file says something that cannot be.
    """
    path = robot.folder / WHOLE_BODY
    return load_toml(path, WholeBodyFile) if path.is_file() else WholeBodyFile(torque=MOST)


def torque_executor(
    robot: RobotDescription, stance: Array, delay: float = 0.0, state: RobotState | None = None
) -> TorqueExecutor:
    """Return what realises motions with the torques of `robot`.

    Args:
        robot: The robot.
        stance: (n,) rad, the pose to stand in.
        delay: From a state being measured to a command for it acting, s.
        state: The robot's state, if it is shared with other controllers; a delay needs its own.
    """
    how = find_whole_body(robot)
    if delay or state is None:
        state = state_of(robot, delay)
    limit = np.minimum(robot.joints.torque, how.torque)
    body = WholeBody(Dynamics(state), limit, how.friction, how.weights)
    return TorqueExecutor(robot.joints, body, stance, robot.contacts, how)
