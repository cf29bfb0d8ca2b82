"""Putting together a walk that the stepper catches."""

from windup.control.limit_cycle.balancer import Balancer
from windup.control.stepping.stepper import Stepper
from windup.control.stepping.supervisor import Supervisor
from windup.hal.errors import UsageError
from windup.robots import RobotDescription
from windup.tools.assembly.stepping import STEPPING, build_stepper, find_stepping, stepping_stance


def build_supervisor(
    robot: RobotDescription, walker: Balancer, way: str | None = None
) -> Supervisor:
    """Return `walker` under a supervisor whose stepper steps in a way, by default the robot's own.

    Raises:
        UnknownNameError: There is no such way.
        UsageError: The robot has no stepping.toml or no [catch] table in it, or the way takes no
            steps.
    """
    stepping = find_stepping(robot)
    table, way = stepping.catch, way or stepping.way
    if table is None:
        raise UsageError(
            f"{robot.name} does not hand its walk over to steps: its {STEPPING} has no [catch]"
        )
    stepper = build_stepper(robot, way, stepping_stance(robot), state=walker.state)
    if not isinstance(stepper, Stepper) or stepper.rule is None:
        raise UsageError(f"--way {way}: a walk is caught by steps; give the name of a step rule")
    start = walker.gait.file.start
    pose = robot.stance if start is None else robot.poses[start]
    return Supervisor(walker, stepper, pose, table)
