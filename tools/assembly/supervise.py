"""Putting together a walk that the stepper catches."""

from windup.control.limit_cycle.balancer import Balancer
from windup.control.stepping.stepper import Stepper
from windup.control.stepping.supervisor import Supervisor
from windup.hal.errors import UsageError
from windup.robots import RobotDescription
from windup.tools.assembly.stepping import STEPPING, build_stepper, find_stepping, stepping_stance


def build_supervisor(
    robot: RobotDescription, walker: Balancer, way: str | None = None, delay: float = 0.0
) -> Supervisor:
    """Return `walker` under a supervisor whose stepper steps in one of the ways.

    Args:
        robot: The robot.
        walker: The walk.
        way: Name of a step rule; the robot's own by default.
        delay: From a state being measured to a command for it acting, s; where torques are.

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
    stance = stepping_stance(robot)
    stepper = build_stepper(robot, way, stance, delay=delay, state=walker.state)
    if not isinstance(stepper, Stepper) or stepper.rule is None:
        raise UsageError(f"--way {way}: a walk is caught by steps; give the name of a step rule")
    start = walker.gait.file.start
    pose = robot.stance if start is None else robot.poses[start]
    # Where steps need a faster loop, the walk keeps the rate that its gait was made for.
    period = None if stepping.rate is None else 1.0 / robot.rate_hz
    return Supervisor(walker, stepper, pose, table, period)
