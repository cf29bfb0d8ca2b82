"""Robot descriptions: one folder per robot, with robot.toml, model.xml and gaits."""

from windup.robots.description import RobotDescription, load_robot, robot_names
from windup.robots.records import Bus, Drive, Fall, Foot, Imu

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
