"""Putting together what steers a walk: speed, side, turns, style, a route."""

from math import radians

from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.style import Styling
from windup.control.regulation.variables import RegulationVariable
from windup.control.steering.course import Course
from windup.control.steering.guide import Steady, WalkCommand
from windup.control.steering.incline import InclineControl
from windup.control.steering.side import SideControl
from windup.control.steering.slip import SlipControl
from windup.control.steering.speed import SpeedControl
from windup.control.steering.steering import Steering
from windup.hal.errors import UsageError
from windup.robots import RobotDescription
from windup.tools.assembly.route import guide_of
from windup.tools.assembly.style_intervals import styles_of_walk
from windup.tools.assembly.walk_options import WalkOptions


def steering_of(
    robot: RobotDescription, gait: Gait, options: WalkOptions, variables: list[RegulationVariable]
) -> Steering:
    """Return what steers a walk; open loop it only follows the gait's own speed.

    Raises:
        UsageError: The gait cannot walk as wanted.
    """
    turn = gait.file.turn
    fastest = 0.0 if turn is None else turn.limit
    if abs(options.turn) > fastest:
        can = f"turns at most at {fastest:g} degrees/s" if fastest else "cannot turn"
        raise UsageError(f"turn {options.turn:g} degrees/s: gait {gait.name!r} {can}")
    order = WalkCommand(options.speed, options.side, radians(options.turn))
    route = guide_of(robot, gait, path=options.path, to=options.to, speed=options.speed)
    heading = None if options.open_loop else gait.file.heading
    return Steering(
        gait=gait,
        guide=route or Steady(order),
        speed=SpeedControl(gait, options.speed),
        side=SideControl(gait, options.side),
        style=Styling(gait, spells=styles_of_walk(options)),
        course=None if heading is None else Course(heading, turn),
        incline=None if options.open_loop else _incline(gait, variables),
        slip=_slip(gait, options),
    )


def _incline(gait: Gait, variables: list[RegulationVariable]) -> InclineControl | None:
    """Return what feels a slope, where the gait wants it and its variable is regulated."""
    law, names = gait.file.incline, [variable.name for variable in variables]
    if law is None or law.variable not in names:
        return None
    return InclineControl(law, names.index(law.variable))


def _slip(gait: Gait, options: WalkOptions) -> SlipControl | None:
    """Return what feels slippery ground, where the gait walks by itself and wants it.

    Another gait that is blended in lands sliding; other regulation has no such targets.
    """
    law = gait.file.slip
    if law is None or options.open_loop or options.rv is not None or options.blend:
        return None
    names = [name.removesuffix("'") for name in gait.graph.names]  # on either foot
    return SlipControl(law, frozenset(i for i, name in enumerate(names) if name in law.states))
