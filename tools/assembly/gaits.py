"""Finding a gait: one of the robot's own by name, or any file by its path."""

import os
from pathlib import Path

from windup.control.pose_graph.gait import Gait, load_gait
from windup.hal.errors import UnknownNameError, UsageError
from windup.hal.joints import Array
from windup.robots import RobotDescription


def find_gait(robot: RobotDescription, name: str) -> Gait:
    """Return a gait or pose graph of `robot` by name, or from the path of a file of your own.

    Raises:
        UnknownNameError: The robot has no such gait.
        UsageError: There is no such file.
        ConfigError: The file says something that cannot be.
    """

    def mirrored(values: Array) -> Array:
        return robot.mirror(values)  # which not every robot has

    return load_gait(gait_path(robot, name), robot.joints, robot.contacts, mirrored)


def gait_path(robot: RobotDescription, name: str) -> Path:
    """Return the file of a gait of `robot`; `name` may be its path (it then ends in .toml).

    Raises:
        UnknownNameError: The robot has no such gait.
        UsageError: There is no such file.
    """
    gaits = robot.gaits()
    if name in gaits:
        return gaits[name]
    if name.endswith(".toml") and os.path.isfile(name):
        return Path(name)
    if name.endswith(".toml"):
        own = f"the gaits of {robot.name} are {', '.join(sorted(gaits))}"
        none = f"{robot.name} has no gaits of its own"
        raise UsageError(f"no file {name}; {own if gaits else none}")
    raise UnknownNameError(f"gait of {robot.name}", name, gaits)
