"""The first motion of a robot that has just been armed: slow, weak, and watched joint by joint.

A wrong wire, a jammed joint or a motor that turns the other way shows itself at the first motion.
So the way from where the robot is to where its behaviour begins is made at a limited speed, with a
stiffness that grows on the way, and ends at once when a joint does not follow.
"""

from dataclasses import replace

import numpy as np

from windup.control.motions.following import Following
from windup.control.motions.planted import Planted
from windup.hal.command import JointCommand
from windup.hal.controller import Begins, Controller, first_pose_of
from windup.hal.errors import FirstMotionError
from windup.hal.geometry.smooth_step import PEAK, smooth_step
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

STIFFENING = 0.6
"""What it takes at least to become stiff, s."""
SETTLING = 0.3
"""How long a joint may take at the end to come to rest, s."""
WATCH = 1.0
"""How long joints are watched that hold still afterwards, s: friction may keep a motor from running
away until then."""
CLOSE = 0.05
"""A way that is shorter at every joint shows nothing of it, rad."""


class FirstMotion:
    """Whether an armed robot still has its first motion before it, and how stiff it is by now.

    It is over once a joint has been moved and all have followed. Until then every controller
    begins with a way to its first pose.

    Args:
        joints: The robot's joints.
        stiffness: (n,) share of each joint's stiffness that it begins with.
        speed: Largest speed of a goal, rad/s.
        lag: How far a joint may be behind its goal, rad.
        planted: Judges whether the soles lie as the joints say, where they are flat.

    Attributes:
        due: The first motion is still to come.
        made: It has been made since torque came on, or there was no way to go.
        share: (n,) of each joint's stiffness now.
        goal: (n,) rad that the joints were told last; None before they were told any.
    """

    goal: Array | None

    def __init__(
        self,
        joints: Joints,
        stiffness: Array,
        speed: float,
        lag: float,
        planted: Planted | None = None,
    ) -> None:
        self.joints, self.speed, self.lag, self.planted = joints, speed, lag, planted
        self._begins_with = stiffness
        self.begin()

    def begin(self) -> None:
        """Torque comes on: begin anew."""
        self.due, self.made, self.goal = True, False, None
        self.share = self._begins_with

    def before(self, controller: Controller, upright: bool) -> "Approach":
        """Return `controller` with the first motion before it, as long as that is due.

        Args:
            controller: The controller.
            upright: The robot is on its feet then, or in somebody's hands.
        """
        return Approach(controller, self, self.planted if upright else None)


class Approach:
    """A controller, after the way to where it begins.

    Args:
        controller: Whose turn it is then. It is reset once more at the end of the way.
        motion: The robot's first motion.
        planted: Judges whether the soles lie as the joints say.

    Attributes:
        active: Still on the way.
    """

    def __init__(
        self, controller: Controller, motion: FirstMotion, planted: Planted | None = None
    ) -> None:
        self.controller, self.motion, self.joints = controller, motion, motion.joints
        self._planted = planted
        self.active = self._needed()

    def reset(self, observation: Observation) -> None:
        """Begin at the present pose.

        Raises:
            StateMissingError: From the controller.
        """
        self._begin(observation, self.motion.goal if self.motion.made else None)
        self.active = self._needed()
        self._following: Following | None = None

    def _begin(self, observation: Observation, goal: Array | None) -> None:
        """Reset the controller; one that starts from a pose starts from the goal there was.

        Joints hang behind their goals under load: from where they are, the goals would drop what
        they bear.
        """
        if goal is not None and isinstance(self.controller, Begins):
            joints = replace(observation.joints, position=goal)
            observation = replace(observation, joints=joints)
        self.controller.reset(observation)

    def _needed(self) -> bool:
        """Return whether there is a way to go first.

        The first command of a controller that does not say where it begins may be the middle of a
        step: a robot that is stiff already, if it has not moved, leaves that to the controller.
        """
        return self.motion.due and (not self.motion.made or isinstance(self.controller, Begins))

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command on the way, or the controller's.

        Raises:
            FirstMotionError: A joint does not follow.
        """
        command = self._command(observation, dt)
        self.motion.goal = command.position
        return command

    def _command(self, observation: Observation, dt: float) -> JointCommand:
        if not self.active:
            return self._left_alone(observation, dt)
        if self._following is None:
            command = self.controller.step(observation, dt)
            if self._is_there(command, observation):
                self.active, self.motion.made = False, True
                return command
            self._plan(command, observation)
        return self._on_the_way(observation, dt)

    def _left_alone(self, observation: Observation, dt: float) -> JointCommand:
        """Return the controller's command; as long as it holds still, its joints have to."""
        command = self.controller.step(observation, dt)
        if self._following is not None:
            moves = np.abs(command.position - self._goal).max() > CLOSE
            if moves or observation.time > self._began + self._seconds + SETTLING + WATCH:
                self._following = None
            else:
                self._following.update(observation, self._goal)
        return command

    def _is_there(self, command: JointCommand, observation: Observation) -> bool:
        """Plan nothing where there is no way, and the joints are stiff."""
        pose = first_pose_of(self.controller, command)
        away = np.abs(pose - observation.joints.position).max()
        return bool(away < CLOSE and (self.motion.share == 1.0).all())

    def _plan(self, command: JointCommand, observation: Observation) -> None:
        """Plan the way to the controller's first pose: from the last goal, or the present pose."""
        joints, before = self.joints, self.motion.goal
        start = observation.joints.position
        if before is not None and self.motion.made:
            start = before
        self._from = np.clip(start, joints.lower, joints.upper)
        first = first_pose_of(self.controller, command)
        self._way = np.clip(first, joints.lower, joints.upper) - self._from
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
        """Let the controller begin; one that starts from a pose starts from the goal."""
        self.active, self._goal = False, goal
        self.motion.made = True
        if np.abs(self._way).max() >= CLOSE:
            self.motion.due = False
        self._begin(observation, goal)
        return self.controller.step(observation, dt)
