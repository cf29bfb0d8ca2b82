"""Protective falling: a landing pose, taken with high stiffness, softened before the impact.

Kenwright 2012, algorithm V-1, case C: not a limp ragdoll, but arms toward the fall and a low body.
The servos never go limp during the fall: with limp knees the trunk would drop freely, and limp
arms would not absorb the impact.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from math import cos, nan

import numpy as np

from windup.control.falling.fall import FallPredictor
from windup.control.returned import returned_command
from windup.hal.command import JointCommand
from windup.hal.controller import Controller
from windup.hal.errors import StateMissingError
from windup.hal.geometry.up_axis import uprightness
from windup.hal.joints import Array, Joints
from windup.hal.observation import JointState, Observation
from windup.hal.publishing.controller_block import BlockNames, BlockPart, ControllerBlock
from windup.hal.publishing.run_state import RunState

EFFORT = 0.85
"""Maximum commanded torque, as a share of a joint's largest torque."""
STILL = 0.3
"""Angular speed below which the base is still, rad/s."""
REST = 0.3
"""Minimum time at that before the robot counts as lying, s."""
LONGEST = 2.5
"""Maximum duration of a fall, s; a robot that has not landed by then is not falling."""


@dataclass(frozen=True)
class ProtectiveFall:
    """Pose and stiffness of a fall in one direction.

    Attributes:
        toward: Direction, rad from straight ahead, positive to the left.
        pose: (n,) landing pose, rad.
        falling: (n,) share of each joint's stiffness until the tilt exceeds `soften`.
        impact: (n,) share of each joint's stiffness from then on.
        soften: Tilt of the base at which the joints are softened for the impact, rad.
    """

    toward: float
    pose: Array
    falling: Array
    impact: Array
    soften: float


def bounded(joints: Joints, pose: Array, share: Array, state: JointState) -> JointCommand:
    """Return the command to take a pose with at most `EFFORT` of each joint's torque.

    A servo that is driven backwards at full voltage carries more than its stall torque, because
    its back-EMF adds up. So the goals are clipped to keep the torque law within::

        |stiffness (goal - q) - damping dq| <= EFFORT torque

    Args:
        joints: The robot's joints.
        pose: (n,) rad.
        share: (n,) of the joints' stiffness.
        state: The joints as observed.
    """
    stiffness = joints.stiffness * share
    most, braking = EFFORT * joints.torque, joints.damping * state.velocity
    lowest = state.position + (braking - most) / stiffness
    highest = state.position + (braking + most) / stiffness
    goal = np.minimum(np.maximum(pose, lowest), highest)
    goal = np.clip(goal, joints.lower, joints.upper)
    return JointCommand.of(joints, position=goal, stiffness=stiffness)


class Phase(Enum):
    """Phase of a protected controller."""

    SAFE = "safe"
    FALLING = "falling"
    IMPACT = "impact"
    LYING = "lying"


FALLS = tuple(phase.value for phase in Phase if phase is not Phase.SAFE)


class Protected:
    """A controller that is replaced by a protective fall once a fall cannot be prevented.

    Args:
        controller: Controller until a fall is predicted.
        predictor: Fall predictor.
        ways: Available falls; the one nearest to the direction of the fall is chosen.
        joints: The robot's joints.

    Attributes:
        phase: Present phase.
        way: The chosen fall, or None.
        began: Time at which the fall was predicted, s, or None.
    """

    def __init__(
        self,
        controller: Controller,
        predictor: FallPredictor,
        ways: Sequence[ProtectiveFall],
        joints: Joints,
    ) -> None:
        self.controller, self.predictor = controller, predictor
        self.ways, self.joints = ways, joints
        self._part = BlockPart.of(controller)
        self._clear()

    def _clear(self) -> None:
        self.phase = Phase.SAFE
        self.way: ProtectiveFall | None = None
        self.began: float | None = None
        self._still: float | None = None

    @property
    def active(self) -> bool:
        """True once a fall has been predicted."""
        return self.phase is not Phase.SAFE

    @property
    def finished(self) -> bool:
        """True once the robot lies still, or `LONGEST` s after the fall was predicted."""
        return self.phase is Phase.LYING

    @property
    def published(self) -> BlockNames:
        """Names of what the controller publishes, with the phases of a fall after its own."""
        falls = BlockNames(phases=FALLS, reasons=("a fall cannot be prevented",))
        return self._part.names + falls

    def publish(self, block: ControllerBlock) -> None:
        """Publish what the controller does, or the phase of the fall."""
        if not self.active:
            self._part.publish(block)
            return
        names = self._part.names
        lies = self.phase is Phase.LYING
        block.run_state = RunState.FALLEN if lies else RunState.FALLING
        block.phase = len(names.phases) + FALLS.index(self.phase.value)
        block.phase_time, block.reason = nan, len(names.reasons)

    def reset(self, observation: Observation) -> None:
        """Start over, with no fall predicted.

        Raises:
            StateMissingError: The observation lacks the base state, or what the controller needs.
        """
        self._clear()
        self.predictor.reset()
        self.predictor.update(observation)
        self.controller.reset(observation)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the controller's command, or that of the protective fall.

        Raises:
            StateMissingError: The observation has no base.
        """
        if not self.active and not self.predictor.update(observation):
            return returned_command(self.controller.step(observation, dt), self.controller)
        if self.way is None or self.began is None:
            self.way, self.began = self._choose(), observation.time
            self.phase = Phase.FALLING
        self._advance(observation, self.way, observation.time - self.began)
        falling = self.phase is Phase.FALLING
        share = self.way.falling if falling else self.way.impact
        return bounded(self.joints, self.way.pose, share, observation.joints)

    def _choose(self) -> ProtectiveFall:
        """Return the available fall nearest to the predicted direction."""
        toward = self.predictor.toward
        assert toward is not None, "a fall has a direction"
        return max(self.ways, key=lambda way: cos(way.toward - toward))

    def _advance(self, observation: Observation, way: ProtectiveFall, passed: float) -> None:
        """Enter the next phase if it is due."""
        base = observation.base
        if base is None:
            raise StateMissingError("the base state was lost in a fall")
        _, x, y, _ = base.orientation
        if self.phase is Phase.FALLING and uprightness(x, y) < cos(way.soften):
            self.phase = Phase.IMPACT
        if float(np.linalg.norm(base.angular_velocity)) > STILL:
            self._still = None
        elif self._still is None:
            self._still = observation.time
        landed = self.phase is Phase.IMPACT and self._still is not None
        if landed and self._still is not None and observation.time >= self._still + REST:
            self.phase = Phase.LYING
        if passed >= LONGEST:
            self.phase = Phase.LYING
