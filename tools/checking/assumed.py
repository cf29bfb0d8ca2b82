"""Notes about what Windup adds to a robot or assumes for keys that its files omit."""

from collections.abc import Iterator

from windup.hal.errors import UsageError
from windup.robots import RobotDescription, mjcf
from windup.robots.completion import COM_VELOCITY
from windup.robots.folders import FILE
from windup.robots.inspection.reading import FolderContents
from windup.tools.assembly.shape import check_walks


def assumed(reading: FolderContents) -> Iterator[str]:
    """Yield the notes about a robot whose files are valid, one line each."""
    robot = reading.robot
    if robot is None:
        return
    yield from _sensors(robot)
    if reading.unlimited:
        names = ", ".join(reading.unlimited)
        yield f"limits of {names}: {FILE} leaves them out, so they are the MJCF's or the servo's"
    yield from _able(robot)


def _sensors(robot: RobotDescription) -> Iterator[str]:
    """Yield notes about added sensors, and about a missing IMU or missing feet."""
    there = {sensor.name for sensor in mjcf.parse_mjcf(robot.model_path).sensors}
    whole = {sensor.name for sensor in robot.spec().sensors}
    if added := sorted(whole - there - {COM_VELOCITY}):
        yield f"sensors that the MJCF lacks are added to the twin: {', '.join(added)}"
    if robot.imu is None and not robot.fixed:
        yield "no [imu]: on a servo bus nothing tells how the base leans, and it cannot walk there"
    if not robot.feet and not robot.fixed:
        yield "no [[foot]]: nothing tells what stands on the ground"


def _able(robot: RobotDescription) -> Iterator[str]:
    """Yield why the robot cannot walk, or that it has no default gait."""
    try:
        check_walks(robot)
    except UsageError as error:
        yield f"it stands and plays graphs; {error}"
        return
    if "walk" not in robot.gaits():
        yield "it has no gait called walk: `windup walk` needs --gait"
