"""What is doubtful about a user's own robot: said once, where it is first used."""

import logging
import shlex
from pathlib import Path

from windup.robots import RobotDescription
from windup.robots.folders import FOLDER
from windup.robots.inspection.robot_warnings import robot_warnings

_looked_at: set[Path] = set()


def doubt_once(robot: RobotDescription) -> None:
    """Warn in one line if something about a robot that is not of the package is doubtful.

    Once a process; processes that are forked from this one have been told, too.
    """
    folder = robot.folder.resolve()
    if folder.parent == FOLDER.resolve() or folder in _looked_at:
        return
    _looked_at.add(folder)
    if count := len(robot_warnings(robot)):
        what = "1 thing is" if count == 1 else f"{count} things are"
        logging.getLogger(__name__).warning(
            "%s doubtful about %s: run `windup check %s`",
            what, robot.name, shlex.quote(str(robot.folder)),
        )  # fmt: skip
