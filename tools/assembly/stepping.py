"""Putting together what stands and steps under pushes, from a robot and the name of a rule."""

from collections.abc import Sequence
from typing import Final

import msgspec
import numpy as np
from shapely.geometry.base import BaseGeometry

from windup.control.footprints.directed_file import Directed
from windup.control.footprints.footprints import Footprint
from windup.control.footprints.keep_out import KeepOutRegions
from windup.control.kinematics.robot_state import RobotState
from windup.control.motions.play import PoseHolder
from windup.control.stepping.footing import Footing
from windup.control.stepping.step_decision import RULES
from windup.control.stepping.stepper import Stepper
from windup.control.stepping.stepping_file import Stepping, Support
from windup.control.stepping.torque_comfort import ComfortWalk, TorqueComfort
from windup.control.stepping.torque_stepper import TorqueStepper
from windup.control.whole_body.dynamics import Dynamics
from windup.control.whole_body.whole_body import WholeBody
from windup.hal.controller import Controller
from windup.hal.errors import UnknownNameError
from windup.hal.joints import Array
from windup.robots import RobotDescription
from windup.tools.assembly.robot_file import load_beside
from windup.tools.assembly.shape import check_walks
from windup.tools.assembly.state import state_of

STEPPING: Final = "stepping.toml"
FOOTPRINTS: Final = "footprints.toml"
FRICTION: Final = 0.8
"""What whole-body control counts on; the floor has 1."""
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
    """Return the feet of `robot`, for a pose (n,) rad to stand in; `state` may be shared."""
    sites = [foot.site for foot in robot.feet]
    return Footing(state or state_of(robot), robot.base, sites, stance)


def whole_body_of(robot: RobotDescription, delay: float = 0.0) -> WholeBody:
    """Return the whole-body control of a robot with torque joints; `delay` of its commands, s."""
    limit = np.minimum(robot.joints.torque, find_stepping(robot).torque)
    return WholeBody(Dynamics(state_of(robot, delay)), limit, FRICTION)


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
    if robot.drive.kind == "torque":
        body = whole_body_of(robot, delay)
        comfort = comfort_of(robot, body, stance, stepping)
        return TorqueStepper(robot.joints, body, stance, rule, stepping, no_step, comfort)
    footing = footing_of(robot, stance, state)
    return Stepper(robot.joints, footing, stance, rule, stepping, no_step)


def comfort_of(
    robot: RobotDescription, body: WholeBody, stance: Array, stepping: Stepping
) -> TorqueComfort:
    """Return the comfort steps of a robot with torque joints, as it walks footprints.

    Raises:
        UsageError: It has no footprints.toml.
    """
    # Feet that stand far apart do not let the weight come all the way over one of them.
    how = msgspec.structs.replace(load_beside(robot, FOOTPRINTS, Directed), patience=1.0)

    def walk(missing: Footprint) -> ComfortWalk:
        return ComfortWalk(robot.joints, body, stance, [missing], how, robot.contacts)

    return TorqueComfort(walk, stepping.comfort)


def check_way(way: str) -> None:
    """Raise when there is no such way to meet a push.

    Raises:
        UnknownNameError: There is none.
    """
    if way not in WAYS:
        raise UnknownNameError("way to meet a push", way, WAYS)
