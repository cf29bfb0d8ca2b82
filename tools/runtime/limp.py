"""The controller of a robot without torque: it commands nothing, and publishes how it is."""

from collections.abc import Callable

from windup.hal.command import JointCommand
from windup.hal.joints import Joints
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import NOTHING, BlockNames, ControllerBlock
from windup.hal.publishing.run_state import RunState


class Limp:
    """A controller for a robot that is only read.

    Args:
        joints: The joints.
        fallen: Returns whether the robot lies.
    """

    published: BlockNames = NOTHING

    def __init__(self, joints: Joints, fallen: Callable[[], bool]) -> None:
        self._joints, self._fallen = joints, fallen

    def reset(self, observation: Observation) -> None:
        """Take the first pose, which is never sent."""
        self._command = JointCommand.hold(self._joints, observation.joints.position)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return a command, which is not sent."""
        return self._command

    def publish(self, block: ControllerBlock) -> None:
        """Publish that the robot is limp, or lies."""
        block.run_state = RunState.FALLEN if self._fallen() else RunState.LIMP
