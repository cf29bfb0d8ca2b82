"""Commands from outside the control loop: from the body of a `for` loop over its ticks."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from windup.control.loop import TickLoop
from windup.hal.backend import Clock
from windup.hal.command import FIELDS, JointCommand
from windup.hal.errors import UsageError, WindupError
from windup.hal.guard import GuardedBackend
from windup.hal.joints import Joints
from windup.hal.observation import Observation
from windup.hal.ranges import Range

LASTING: Final = Range(0.0, 1e9, "s")
"""Valid durations of a run."""


class GivenCommand:
    """A controller that returns the last command given from outside.

    Args:
        joints: The robot's joints.
        held: The command until one is given; by default to hold the first observed pose.
    """

    def __init__(self, joints: Joints, held: JointCommand | None = None) -> None:
        self.joints, self.command = joints, held

    def reset(self, observation: Observation) -> None:
        """Hold the observed pose, unless there is a command already."""
        if self.command is None:
            self.command = hold_pose(self.joints, observation)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the last command that was given."""
        assert self.command is not None, "a controller is reset first"
        return self.command


@dataclass
class Body:
    """The body of a loop over ticks: what it reads and writes between two ticks.

    Attributes:
        loop: The loop that it belongs to.
        given: Takes the commands that it writes.
        fail: Stops the robot after an error.
        failed: An error has stopped the robot.
    """

    loop: TickLoop
    given: GivenCommand
    fail: Callable[[WindupError], None]
    failed: bool = False

    def write(self, command: JointCommand) -> JointCommand:
        """Send the command of this tick; return the command that the joints really got.

        Raises:
            WindupError: From the guard or the backend; the robot has stopped.
        """
        self.given.command = command
        try:
            return self.loop.command()
        except WindupError as error:
            self.failed = True
            self.fail(error)
            raise


class ReadOnly:
    """A backend that is only read: nothing is sent to joints that may get no torque.

    Args:
        backend: The backend.
    """

    def __init__(self, backend: GuardedBackend) -> None:
        self.clock: Clock = backend.clock
        self.read = backend.read
        self._nothing = JointCommand(np.full((len(FIELDS), len(backend.joints)), np.nan))

    def write(self, command: JointCommand) -> JointCommand:
        """Send nothing, and return a command of NaN: the joints got none."""
        return self._nothing


def hold_pose(joints: Joints, observation: Observation) -> JointCommand:
    """Return the command to hold the pose of an observation, within the joints' limits."""
    return JointCommand.hold(
        joints, np.clip(observation.joints.position, joints.lower, joints.upper)
    )


def check_command(command: object) -> None:
    """Raise unless this is a command.

    Raises:
        UsageError: It is not one.
    """
    if not isinstance(command, JointCommand):
        raise UsageError(
            f"robot.write() takes a JointCommand, not {type(command).__name__}: "
            "type JointCommand.of(robot.joints, position=...)"
        )


def check_controller(controller: object) -> None:
    """Raise unless this is a controller.

    Raises:
        UsageError: It is a class, or lacks a method; nothing has moved.
    """
    if isinstance(controller, type):
        name = controller.__name__
        raise UsageError(f"robot.run() takes a controller, not the class {name}: give {name}(...)")
    for method in ("reset(observation)", "step(observation, dt)"):
        if not callable(getattr(controller, method.partition("(")[0], None)):
            raise UsageError(
                f"robot.run() takes a controller, not {type(controller).__name__}: it has no "
                f"{method}"
            )
