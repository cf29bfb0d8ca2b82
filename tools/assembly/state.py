"""The state of a robot's whole body, made from its description."""

from windup.control.kinematics.robot_state import RobotState
from windup.robots import RobotDescription


def state_of(robot: RobotDescription, ahead: float = 0.0) -> RobotState:
    """Return a `RobotState` of `robot`, with positions extrapolated by `ahead` s.

    Controllers of one robot that are given the same one compute its quantities once a tick.
    """
    return RobotState(
        robot.model,
        robot.base,
        robot.torso,
        [foot.site for foot in robot.feet],
        feet=[foot.body for foot in robot.feet],
        contacts=robot.contacts,
        ahead=ahead,
    )
