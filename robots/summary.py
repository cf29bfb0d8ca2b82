"""Summary of a robot from its robot.toml alone; does not compile the MJCF or need MuJoCo."""

from pathlib import Path
from typing import NamedTuple

from windup.hal.config import load_toml
from windup.robots.folders import FILE, gait_files
from windup.robots.records import RobotFile


class Summary(NamedTuple):
    """What a list of robots shows of one.

    Attributes:
        robot: Name of the robot.
        title: Display name.
        joints: Number of joints.
        drive: Kind of actuators.
        rate_hz: Rate of the control loop, Hz.
        gaits: Names of its gaits, sorted.
    """

    robot: str
    title: str
    joints: int
    drive: str
    rate_hz: float
    gaits: list[str]


def summarise(folder: Path) -> Summary:
    """Return the summary of the robot in a folder.

    Raises:
        ConfigError: Its robot.toml cannot be read or does not fit the record.
    """
    robot = load_toml(folder / FILE, RobotFile)
    gaits = sorted(gait_files(folder))
    return Summary(
        robot.name, robot.title, len(robot.joint), robot.drive.kind, robot.rate_hz, gaits
    )
