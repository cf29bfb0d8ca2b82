"""Putting together how a robot falls: what foresees it, and the poses of its `[fall]` table."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from windup.control.kinematics.robot_state import RobotState
from windup.hal.controller import Controller
from windup.hal.joints import Array, Mask
from windup.robots import RobotDescription
from windup.robots.records import StiffnessShares
from windup.tools.assembly.state import state_of

if TYPE_CHECKING:
    from windup.control.falling.protection import Protected, ProtectiveFall


@dataclass
class Protection:
    """How the falls of one robot are softened.

    Attributes:
        robot: The robot.
    """

    robot: RobotDescription

    @property
    def possible(self) -> bool:
        """Does the robot's file say how it falls?"""
        return bool(self.robot.fall.way)

    def around(self, controller: Controller, reads: object) -> "Protected":
        """Return `controller`, protected.

        Args:
            controller: The controller.
            reads: What of it may have a `state`: the fall is foreseen by the same one, so that a
                tick computes it once.
        """
        from windup.control.falling.fall import FallPredictor
        from windup.control.falling.protection import Protected

        reach, state = self.robot.fall.reach, getattr(reads, "state", None)
        assert reach is not None, "the robot's file was checked"
        if not isinstance(state, RobotState):
            state = self._state
        predictor = FallPredictor(state, reach)
        return Protected(controller, predictor, self._ways, self.robot.joints)

    @cached_property
    def _state(self) -> RobotState:
        """The state that a fall is foreseen by where the controller has none."""
        return state_of(self.robot)

    @cached_property
    def _ways(self) -> "tuple[ProtectiveFall, ...]":
        from windup.control.falling.protection import ProtectiveFall

        robot = self.robot
        legs = leg_joints(robot, robot.model)
        return tuple(
            ProtectiveFall(
                way.toward,
                robot.poses[way.pose],
                spread(way.falling, legs),
                spread(way.impact, legs),
                way.soften,
            )
            for way in robot.fall.way
        )


def leg_joints(robot: RobotDescription, model: mujoco.MjModel) -> Mask:
    """Return (n,) bool: the joints between the base and a foot."""
    bodies = set()
    for foot in robot.feet:
        body = model.body(foot.body).id
        while body and body != model.body(robot.base).id:
            bodies.add(body)
            body = int(model.body_parentid[body])
    return np.array([int(model.joint(name).bodyid[0]) in bodies for name in robot.joints.names])


def spread(shares: StiffnessShares, legs: Mask) -> Array:
    """Return (n,) the share of each joint; `legs` (n,) bool are those between base and feet."""
    return np.where(legs, shares.legs, shares.others)
