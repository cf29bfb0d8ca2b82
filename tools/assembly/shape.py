"""What the shape of a robot lets it do: whoever is fixed, or has no two feet, cannot walk."""

from windup.hal.errors import UsageError
from windup.robots import RobotDescription


def check_walks(robot: RobotDescription, what: str = "walk") -> None:
    """Raise unless a robot has what walking, stepping and balancing are made for.

    Args:
        robot: The robot.
        what: What it shall do, for the message.

    Raises:
        UsageError: It has not; nothing has moved.
    """
    if why := _unable(robot):
        raise UsageError(f"{robot.name} cannot {what}: {why}")


def can_estimate(robot: RobotDescription) -> bool:
    """Return whether the state of the base can be estimated from IMU and encoders."""
    return bool(robot.imu and robot.feet) and not (robot.fixed or robot.passive)


def _unable(robot: RobotDescription) -> str:
    """Return what keeps a robot from walking, or ""."""
    if robot.fixed:
        return "its base is fixed, for the MJCF has no free joint"
    if len(robot.feet) != 2:
        return f"that takes two feet, and robot.toml has {len(robot.feet)} ([[foot]])"
    if robot.passive:
        names = ", ".join(robot.passive)
        return f"the control of legs knows nothing of passive joints ({names})"
    for foot in robot.feet:
        if not foot.side:
            return f'nobody says which side foot {foot.name!r} is on: give side = "left" or "right"'
        if not foot.sensors:
            return f"foot {foot.name!r} has no touch sensor: leave `sensors` away, and it gets one"
    return ""
