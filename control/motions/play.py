"""Controllers that play a pose graph or hold one pose, without balance or steps."""

import numpy as np

from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.pose_tracker import PoseTracker
from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.controller import PolicyInput
from windup.hal.geometry.smooth_step import smooth_step
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import BlockNames, ControllerBlock
from windup.hal.publishing.run_state import RunState


class PoseHolder:
    """Controller that moves to one pose along a smooth step, and holds it.

    Args:
        joints: The robot's joints.
        pose: (n,) rad.
        ramp: Time from the present pose to `pose`, s.
    """

    def __init__(self, joints: Joints, pose: Array, ramp: float = 0.5) -> None:
        self.joints, self.pose, self.ramp = joints, pose, ramp

    @property
    def first_pose(self) -> Array:
        """First pose (n,), rad; see `HasFirstPose`."""
        return self.pose

    def reset(self, observation: Observation) -> None:
        """Start the motion at the present pose."""
        self._from, self._began = observation.joints.position, observation.time

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of this tick: an intermediate pose, or the pose itself."""
        s = min((observation.time - self._began) / self.ramp, 1.0) if self.ramp > 0.0 else 1.0
        way = smooth_step(s) * (self.pose - self._from)
        return JointCommand.hold(self.joints, self._from + way)


class GraphPlayer:
    """Controller that plays a pose graph from its first state.

    Args:
        gait: The graph; its perturbations stay at zero.
        joints: The robot's joints.
        contacts: The robot's contact sensors.

    Attributes:
        failed: Always None, because no state has a condition that could fail.
        retries: Always 0, for the same reason.
    """

    failed: str | None = None
    retries = 0

    def __init__(self, gait: Gait, joints: Joints, contacts: ContactSensors) -> None:
        self.joints = joints
        self._tracker = PoseTracker(gait, contacts, np.zeros((1, len(gait.perturbations))))
        self.published = BlockNames(phases=gait.graph.names)
        steps = bool(gait.graph.ends_step.any())
        self._state = RunState.WALKING if steps else RunState.STANDING

    def reset(self, observation: Observation) -> None:
        """Start at the first state."""
        self._tracker.restart()
        self._hold = JointCommand.hold(self.joints, observation.joints.position)
        self._begun = False

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command for the pose of the present state."""
        if self._begun:
            self._tracker.advance(observation.contacts[None])
        self._begun = True
        nothing = np.zeros((1, 0))
        state = PolicyInput(nothing, nothing, nothing, nothing, observation.contacts[None])
        return self._hold.with_position(self._tracker.step(state, dt)[0])

    def publish(self, block: ControllerBlock) -> None:
        """Publish the state of the graph."""
        block.run_state, block.phase = self._state, int(self._tracker.state[0])
        block.phase_time = float(self._tracker.elapsed[0])

    @property
    def finished(self) -> bool:
        """True if an aperiodic graph has held its last state for the hold time."""
        return bool(self._tracker.finished()[0])
