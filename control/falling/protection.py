"""Falling well: a pose to land in, strong while it is taken, soft as the ground comes near.

Kenwright 2012, algorithm V-1, case C: not a limp ragdoll, but arms toward the fall and a low body.
Servos that hold the body never go limp in mid-air: knees that give way at once drop the trunk
freely, and arms without strength catch nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from math import cos

import numpy as np

from windup.control.falling.fall import FallPredictor
from windup.hal.command import JointCommand
from windup.hal.controller import Controller
from windup.hal.errors import StateMissingError
from windup.hal.geometry.up_axis import uprightness
from windup.hal.joints import Array, Joints
from windup.hal.observation import JointState, Observation

EFFORT = 0.85
"""Share of a joint's largest torque that is asked of it."""
STILL = 0.3
"""Turn rate below which a base lies still, rad/s."""
REST = 0.3
"""How long it has to, s."""
LONGEST = 2.5
"""A fall takes no longer than this, s; a robot that has not landed by then does not fall."""


@dataclass(frozen=True)
class FallWay:
    """How to fall toward one side.

    Attributes:
        toward: Which side, rad from straight ahead, positive to the left.
        pose: (n,) rad to take.
        falling: (n,) share of each joint's stiffness until the impact is near.
        impact: (n,) the same from then on.
        soften: Tilt of the base at which the impact is near, rad.
    """

    toward: float
    pose: Array
    falling: Array
    impact: Array
    soften: float


def bounded(joints: Joints, pose: Array, share: Array, state: JointState) -> JointCommand:
    """Return the command that takes a pose and asks of no joint more than `EFFORT`.

    A servo that is thrown back while it pulls with all its voltage bears more than at stall, for
    its back-EMF adds up. So goals stay as near as the torque law allows::

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
    """What a protected controller is at."""

    SAFE = "safe"
    FALLING = "falling"
    IMPACT = "impact"
    LYING = "lying"


class Protected:
    """Any controller, and a protective fall once its robot can no longer be kept from falling.

    Args:
        controller: Who controls as long as there is no such fall.
        predictor: Foresees one.
        ways: How to fall; the one whose side is nearest is taken.
        joints: The robot's joints.

    Attributes:
        phase: What it is at.
        way: The way chosen, or None.
        began: When the fall was foreseen, s, or None.
    """

    def __init__(
        self,
        controller: Controller,
        predictor: FallPredictor,
        ways: Sequence[FallWay],
        joints: Joints,
    ) -> None:
        self.controller, self.predictor = controller, predictor
        self.ways, self.joints = ways, joints
        self._clear()

    def _clear(self) -> None:
        self.phase = Phase.SAFE
        self.way: FallWay | None = None
        self.began: float | None = None
        self._still: float | None = None

    @property
    def active(self) -> bool:
        """True from the moment a fall was foreseen."""
        return self.phase is not Phase.SAFE

    @property
    def finished(self) -> bool:
        """True once the robot lies still."""
        return self.phase is Phase.LYING

    def reset(self, observation: Observation) -> None:
        """Begin anew.

        Raises:
            StateMissingError: From the controller, or there is no base state to see a fall in.
        """
        self._clear()
        self.predictor.reset()
        self.predictor.update(observation)
        self.controller.reset(observation)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the controller's command, or that of the fall.

        Raises:
            StateMissingError: The observation has no base.
        """
        if not self.active and not self.predictor.update(observation):
            return self.controller.step(observation, dt)
        if self.way is None or self.began is None:
            self.way, self.began = self._choose(), observation.time
            self.phase = Phase.FALLING
        self._advance(observation, self.way, observation.time - self.began)
        falling = self.phase is Phase.FALLING
        share = self.way.falling if falling else self.way.impact
        return bounded(self.joints, self.way.pose, share, observation.joints)

    def _choose(self) -> FallWay:
        """Return the way whose side is nearest."""
        toward = self.predictor.toward
        assert toward is not None, "a fall has a direction"
        return max(self.ways, key=lambda way: cos(way.toward - toward))

    def _advance(self, observation: Observation, way: FallWay, passed: float) -> None:
        """Move on to the next phase when it is time."""
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
