"""The supervisor of a walk that catches pushes, imported only where one is wanted."""

from typing import TYPE_CHECKING

from windup.robots import RobotDescription
from windup.tools.assembly.walk_options import WalkOptions

if TYPE_CHECKING:
    from windup.control.limit_cycle.balancer import Balancer
    from windup.control.stepping.supervisor import Supervisor


def supervisor_for(
    robot: RobotDescription, walker: "Balancer", options: WalkOptions, delay: float = 0.0
) -> "Supervisor | None":
    """Return the supervisor that catches pushes, or None where the options want none.

    The `delay` is from a state being measured to a command for it acting, s.
    """
    if not options.catch:
        return None
    from windup.tools.assembly.supervise import build_supervisor

    return build_supervisor(robot, walker, options.way, delay)
