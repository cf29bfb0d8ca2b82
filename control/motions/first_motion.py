"""The first motion after torque enable: slow, with low stiffness, and checked joint by joint.

Wrong wiring, a jammed joint or a motor that turns the other way shows at the first motion. So the
robot moves from its present pose to the first pose of its controller at a limited speed, with a
stiffness that ramps up, and the motion is aborted as soon as a joint does not follow.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from windup.control.motions.following import Following
from windup.control.motions.planted import Planted
from windup.control.returned import returned_command
from windup.hal.command import JointCommand
from windup.hal.controller import Controller, HasFirstPose, first_pose_of
from windup.hal.errors import FirstMotionError
from windup.hal.geometry.smooth_step import PEAK, smooth_step
from windup.hal.joints import Array, Joints, Mask
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import UNKNOWN, BlockNames, BlockPart, ControllerBlock

STIFFENING = 0.6
"""Minimum duration of the stiffness ramp, s."""
SETTLING = 0.3
"""Time at the end for the joints to come to rest, s."""
WATCH = 1.0
"""Time after that in which joints that hold still are checked, s: friction may delay a runaway
motor until then."""
CLOSE = 0.05
"""Minimum motion of a joint that proves anything about it, rad."""


class FirstMotion:
    """Progress of an armed robot's first motion, and its present stiffness.

    The first motion is complete once a joint has moved and all joints have followed. Until then
    every controller is preceded by a motion to its first pose.

    Args:
        joints: The robot's joints.
        stiffness: (n,) initial share of each joint's stiffness.
        speed: Maximum speed of a goal, rad/s.
        lag: Maximum position error of a joint, rad.
        planted: Check of the soles against the floor, or None if the soles are not flat.
        clipped: Called with the joints (n,) bool whose first goal was beyond their limits.

    Attributes:
        due: The first motion is not complete yet.
        made: A motion has been made since torque enable, or none was necessary.
        share: (n,) present share of each joint's stiffness.
        goal: (n,) last commanded goal positions, rad; None before the first command.
    """

    goal: Array | None

    def __init__(
        self,
        joints: Joints,
        stiffness: Array,
        speed: float,
        lag: float,
        planted: Planted | None = None,
        clipped: Callable[[Mask], None] = lambda beyond: None,
    ) -> None:
        self.clipped = clipped
        self.joints, self.speed, self.lag, self.planted = joints, speed, lag, planted
        self._begins_with = stiffness
        self.begin()

    def begin(self) -> None:
        """Start over, at torque enable."""
        self.due, self.made, self.goal = True, False, None
        self.share = self._begins_with

    def before(self, controller: Controller, upright: bool) -> "Approach":
        """Return `controller` preceded by the first motion, as long as that is due.

        Args:
            controller: The controller.
            upright: The robot then stands on its feet, or is held in somebody's hands.
        """
        return Approach(controller, self, self.planted if upright else None)


class Approach:
    """A controller preceded by a motion to its first pose.

    Args:
        controller: The controller that follows. It is reset again at the end of the motion.
        motion: Progress of the robot's first motion.
        planted: Check of the soles against the floor, or None.

    Attributes:
        active: The motion to the first pose is not finished.
    """

    def __init__(
        self, controller: Controller, motion: FirstMotion, planted: Planted | None = None
    ) -> None:
        self.controller, self.motion, self.joints = controller, motion, motion.joints
        self._planted = planted
        self._part = BlockPart.of(controller)
        self.active = self._needed()

    @property
    def published(self) -> BlockNames:
        """Names of what the controller publishes."""
        return self._part.names

    def publish(self, block: ControllerBlock) -> None:
        """Publish what the controller does, once it has the robot."""
        if self.active:
            block.phase = block.reason = UNKNOWN
        else:
            self._part.publish(block)

    def reset(self, observation: Observation) -> None:
        """Start at the present pose.

        Raises:
            StateMissingError: The controller needs what the observation lacks.
        """
        self._begin(observation, self.motion.goal if self.motion.made else None)
        self.active = self._needed()
        self._following: Following | None = None

    def _begin(self, observation: Observation, goal: Array | None) -> None:
        """Reset the controller; a `HasFirstPose` controller starts from `goal`, if that is given.

        Loaded joints lag behind their goals: with goals at the measured positions they would sag.
        """
        if goal is not None and isinstance(self.controller, HasFirstPose):
            joints = replace(observation.joints, position=goal)
            observation = replace(observation, joints=joints)
        self.controller.reset(observation)

    def _needed(self) -> bool:
        """Return whether a motion to the first pose is necessary.

        Without `HasFirstPose`, the first command of a controller may be the middle of a step: a
        robot that has full stiffness already then goes without this motion.
        """
        return self.motion.due and (
            not self.motion.made or isinstance(self.controller, HasFirstPose)
        )

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of the motion to the first pose, afterwards the controller's.

        Raises:
            FirstMotionError: A joint does not follow.
            ControllerError: The controller returned no command.
            UnsafeCommandError: It returned one for another number of joints.
        """
        command = self._command(observation, dt)
        self.motion.goal = command.position
        return command

    def _command(self, observation: Observation, dt: float) -> JointCommand:
        if not self.active:
            return self._left_alone(observation, dt)
        if self._following is None:
            command = self._asked(observation, dt)
            if self._is_there(command, observation):
                self.active, self.motion.made = False, True
                return command
            self._plan(command, observation)
        return self._on_the_way(observation, dt)

    def _left_alone(self, observation: Observation, dt: float) -> JointCommand:
        """Return the controller's command; check the joints as long as it holds still."""
        command = self._asked(observation, dt)
        if self._following is not None:
            moves = np.abs(command.position - self._goal).max() > CLOSE
            if moves or observation.time > self._began + self._seconds + SETTLING + WATCH:
                self._following = None
            else:
                self._following.update(observation, self._goal)
        return command

    def _asked(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of the controller, whose shape the motion relies on."""
        returned = self.controller.step(observation, dt)
        return returned_command(returned, self.controller, len(self.joints))

    def _is_there(self, command: JointCommand, observation: Observation) -> bool:
        """Return whether the robot is at the first pose already, with full stiffness."""
        pose = first_pose_of(self.controller, command)
        away = np.abs(pose - observation.joints.position).max()
        return bool(away < CLOSE and (self.motion.share == 1.0).all())

    def _plan(self, command: JointCommand, observation: Observation) -> None:
        """Plan the motion to the controller's first pose, from the last goal or present pose."""
        joints, before = self.joints, self.motion.goal
        start = observation.joints.position
        if before is not None and self.motion.made:
            start = before
        self._from = np.clip(start, joints.lower, joints.upper)
        first = first_pose_of(self.controller, command)
        goal = np.clip(first, joints.lower, joints.upper)
        if (beyond := goal != first).any():
            self.motion.clipped(beyond)
        self._way = goal - self._from
        self._began, self._share = observation.time, self.motion.share
        longest = float(np.abs(self._way).max())
        weak = STIFFENING if (self._share < 1.0).any() else SETTLING
        self._seconds = max(PEAK * longest / self.motion.speed, weak)
        self._following = Following(joints, self._from, self._way, self.motion.lag)
        if self._planted is not None:
            self._planted.begin()

    def _on_the_way(self, observation: Observation, dt: float) -> JointCommand:
        passed = observation.time - self._began
        s = min(passed / self._seconds, 1.0)
        smooth = smooth_step(s)
        assert self._following is not None, "planned before"
        goal = self._from + smooth * self._way
        if passed >= self._seconds + SETTLING:
            self._following.conclude(observation.joints.position)
            return self._hand_over(observation, goal, dt)
        self._following.update(observation, goal)
        if self._planted is not None and (wrong := self._planted.update(observation)) is not None:
            raise FirstMotionError(wrong)
        self.motion.share = self._share + smooth * (1.0 - self._share)
        stiffness = self.joints.stiffness * self.motion.share
        return JointCommand.of(self.joints, position=goal, stiffness=stiffness)

    def _hand_over(self, observation: Observation, goal: Array, dt: float) -> JointCommand:
        """Finish the motion: reset the controller and return its first command."""
        self.active, self._goal = False, goal
        self.motion.made = True
        if np.abs(self._way).max() >= CLOSE:
            self.motion.due = False
        self._begin(observation, goal)
        return self._asked(observation, dt)
