"""Putting together what stands and steps under pushes, from a robot and the name of a rule."""

from collections.abc import Sequence
from typing import Final

import msgspec
from shapely.geometry.base import BaseGeometry

from windup.control.execution.executor import StepExecutor
from windup.control.execution.footing import Footing
from windup.control.execution.servo_executor import ServoExecutor
from windup.control.footprints.keep_out import KeepOutRegions
from windup.control.kinematics.robot_state import RobotState
from windup.control.motions.play import PoseHolder
from windup.control.stepping.step_decision import RULES
from windup.control.stepping.stepper import Stepper
from windup.control.stepping.stepping_file import Stepping, Support
from windup.hal.controller import Controller
from windup.hal.errors import UnknownNameError
from windup.hal.joints import Array
from windup.robots import RobotDescription
from windup.tools.assembly.robot_file import load_beside
from windup.tools.assembly.shape import check_walks
from windup.tools.assembly.state import state_of
from windup.tools.assembly.torques import torque_executor

STEPPING: Final = "stepping.toml"
HOLD, FEET = "hold", "feet"
WAYS: Final = (HOLD, FEET, *RULES)
"""Ways to meet a push: a stiff pose, balance with the feet alone, or steps by one of the rules."""


def find_stepping(robot: RobotDescription) -> Stepping:
    """Return how `robot` steps.

    Raises:
        UsageError: It has no stepping.toml.
        ConfigError: That file says something that cannot be.
    """
    return load_beside(robot, STEPPING, Stepping)


def stepping_stance(robot: RobotDescription, name: str | None = None) -> Array:
    """Return a pose (n,) rad of `robot` by name; by default the one that it stands in to step.

    Raises:
        UnknownNameError: There is no such pose.
        UsageError: The robot has no stepping.toml.
    """
    name = name or find_stepping(robot).stance
    if name not in robot.poses:
        raise UnknownNameError(f"pose of {robot.name}", name, robot.poses)
    return robot.poses[name]


def footing_of(robot: RobotDescription, stance: Array, state: RobotState | None = None) -> Footing:
    """Return the feet of `robot`, for a pose (n,) rad to stand in; a state may be shared."""
    sites = [foot.site for foot in robot.feet]
    return Footing(state or state_of(robot), robot.base, sites, stance)


def build_stepper(
    robot: RobotDescription,
    way: str,
    stance: Array,
    forbid: Sequence[BaseGeometry] = (),
    support: Support | None = None,
    delay: float = 0.0,
    state: RobotState | None = None,
) -> Controller:
    """Return the controller that meets pushes in one of the `WAYS`, standing in a pose (n,) rad.

    Args:
        robot: The robot.
        way: Which way.
        stance: The pose.
        forbid: Ground where no foot may come down; see `KeepOutRegions`.
        support: What the soles are taken to support; what its stepping says by default.
        delay: From a state being measured to a command for it acting, s; where torques are.
        state: The robot's state, if it is shared with other controllers.

    Raises:
        UnknownNameError: There is no such way.
        UsageError: The robot has no stepping.toml, or not two feet.
    """
    check_way(way)
    if way == HOLD:
        return PoseHolder(robot.joints, stance, ramp=0.0)
    check_walks(robot, "step")
    stepping = find_stepping(robot)
    rule = None if way == FEET else stepping.find_rule(way)
    if support is not None:
        stepping = msgspec.structs.replace(stepping, support=support)
    no_step = KeepOutRegions(forbid, stepping.clear)
    return Stepper(_executor(robot, stance, stepping, delay, state), rule, stepping, no_step)


def _executor(
    robot: RobotDescription,
    stance: Array,
    stepping: Stepping,
    delay: float,
    state: RobotState | None,
) -> StepExecutor:
    """Return what realises the steps with the joints of `robot`."""
    if robot.drive.kind == "torque":
        return torque_executor(robot, stance, delay, state)
    return ServoExecutor(robot.joints, footing_of(robot, stance, state), stance, stepping)


def check_way(way: str) -> None:
    """Raise when there is no such way to meet a push.

    Raises:
        UnknownNameError: There is none.
    """
    if way not in WAYS:
        raise UnknownNameError("way to meet a push", way, WAYS)
