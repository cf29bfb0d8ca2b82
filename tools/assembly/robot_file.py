"""A table that a robot may have beside its robot.toml."""

from typing import TypeVar

from windup.hal.config import load_toml
from windup.hal.errors import UsageError
from windup.robots import RobotDescription
from windup.robots.folders import robot_folders

T = TypeVar("T")


def load_beside(robot: RobotDescription, name: str, record: type[T]) -> T:
    """Return the file `name` of a robot's folder as a `record`.

    Raises:
        UsageError: The robot has no such file; the message says which robots have.
        ConfigError: The file says something that cannot be.
    """
    path = robot.folder / name
    if not path.is_file():
        able = [other for other, folder in robot_folders().items() if (folder / name).is_file()]
        raise UsageError(f"{robot.name} has no {name}; robots that have: {', '.join(able)}")
    return load_toml(path, record)
