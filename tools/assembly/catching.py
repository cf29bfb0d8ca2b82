"""The supervisor of a walk that catches pushes, imported only where one is wanted."""

from typing import TYPE_CHECKING

from windup.robots import RobotDescription

if TYPE_CHECKING:
    from windup.control.limit_cycle.balancer import Balancer
    from windup.control.stepping.supervisor import Supervisor


def supervisor_for(
    robot: RobotDescription, walker: "Balancer", catch: str | None, delay: float
) -> "Supervisor | None":
    """Return the supervisor that catches pushes by the rule `catch`, or None without a rule.

    The `delay` is from a state being measured to a command for it acting, s.
    """
    if catch is None:
        return None
    from windup.tools.assembly.supervise import build_supervisor

    return build_supervisor(robot, walker, catch, delay)
