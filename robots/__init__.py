"""Robot descriptions: one folder per robot, with robot.toml, model.xml and gaits.

`RobotDescription` and `load_robot` are imported when they are first used: they import MuJoCo.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from windup.robots.folders import robot_names
from windup.robots.records import Bus, Drive, Fall, Foot, Imu

if TYPE_CHECKING:
    from windup.robots.description import RobotDescription, load_robot

__all__ = [
    "Bus",
    "Drive",
    "Fall",
    "Foot",
    "Imu",
    "RobotDescription",
    "load_robot",
    "robot_names",
]


def __getattr__(name: str) -> Any:
    """Import `RobotDescription` or `load_robot`.

    Raises:
        AttributeError: There is no such name.
    """
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module("windup.robots.description"), name)
