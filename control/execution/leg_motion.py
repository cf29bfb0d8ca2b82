"""Tracking of a planned CoM and swing foot by two legs with position servos.

The feet on the ground are measured at every tick, so that errors do not accumulate. The commands
contain feedforward torques against gravity and feedforward velocities.
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from windup.control.execution.weight import holding_torque
from windup.control.kinematics.limb_ik import LimbIk, Pose
from windup.control.kinematics.places import ground_places
from windup.control.kinematics.robot_state import RobotState
from windup.control.kinematics.rotation import heading, turn, turn_between
from windup.hal.command import JointCommand
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

MOST_SHIFT, MOST_TILT = 0.02, 0.1
"""Maximum integral corrections of the CoM, m, and of the tilt, rad."""
PRESS = 0.002
"""Depth below the ground to which a landing foot is commanded, so that it touches, m."""
FAST, SMOOTH = 4.8, 0.02
"""Maximum feedforward velocity, rad/s, and time constant of its low-pass filter, s."""
ITERATIONS = 3
"""Iterations of the inverse kinematics per tick, started at the solution of the last tick."""


class Gains(Protocol):
    """Feedback gains, as `footprints.toml` or `stride.toml` gives them."""

    @property
    def hold(self) -> float:
        """Proportional gain on the CoM position error."""
        ...

    @property
    def brake(self) -> float:
        """Derivative gain on the CoM velocity error, s."""
        ...

    @property
    def level(self) -> float:
        """Proportional gain on the tilt of the base."""
        ...

    @property
    def steady(self) -> float:
        """Derivative gain on the tilt rate of the base, s."""
        ...

    @property
    def follow(self) -> float:
        """Integral gain on the CoM error and on the tilt, 1/s."""
        ...

    @property
    def slow(self) -> float:
        """Time constant of the low-pass filter on the gravity torques, s."""
        ...


TAKE_OFF = 0.2
"""Fraction of the swing in which the leg changes from stance to swing control."""


@dataclass
class Aim:
    """Desired state of this tick.

    Attributes:
        com: (2,) desired position of the centre of mass, m.
        speed: (2,) desired velocity of the centre of mass, m/s.
        height: Height of the base above the ground, m.
        yaw: Heading of the base, rad.
        right_load: Share of the weight on the second foot, the right one.
        flying: Index of the foot that is in the air or has just come down, or None.
        standing: Blend of that leg between swing control (0) and stance control (1).
    """

    com: Array
    speed: Array
    height: float
    yaw: float
    right_load: float
    flying: int | None = None
    standing: float = 1.0


class LegMotion(ABC):
    """Controller that tracks a plan with both legs; subclasses supply the plan.

    Args:
        joints: The robot's joints.
        state: The robot's state.
        limbs: Inverse kinematics of the two legs, in the order of the soles.
        stance: (n,) rad, the pose to start from; joints outside the legs keep it.
        gains: Feedback gains.

    Attributes:
        places: (2, 3) measured places of the feet, x m, y m, yaw rad.
    """

    places: Array

    def __init__(
        self,
        joints: Joints,
        state: RobotState,
        limbs: Sequence[LimbIk],
        stance: Array,
        gains: Gains,
    ) -> None:
        self.joints, self.state, self.limbs = joints, state, limbs
        self.stance, self.gains = stance, gains

    @abstractmethod
    def plan(self, now: float, dt: float) -> Aim:
        """Return the aim of this tick; `update` has been called before."""

    @abstractmethod
    def sole(self, foot: int) -> Pose:
        """Return the desired pose of the sole of a foot on the ground."""

    @abstractmethod
    def flying(self, foot: int) -> Pose:
        """Return the desired pose of the sole of a foot in the air."""

    def reset(self, observation: Observation) -> None:
        """Start from the measured state; all integrators and filters are cleared."""
        self.update(observation)
        self._hold = JointCommand.hold(self.joints, self.stance)
        self._last = [observation.joints.position.copy() for _ in self.limbs]
        self._before: Array | None = None
        self._lead = np.zeros(len(self.joints))
        self._torque = np.zeros(len(self.joints))
        self._shift, self._tilt = np.zeros(2), np.zeros(3)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of this tick."""
        self.update(observation)
        return self.command(self.plan(observation.time, dt), dt)

    def command(self, aim: Aim, dt: float) -> JointCommand:
        """Return the command that tracks `aim`; `update` has been called in this tick."""
        base = self._base(aim, dt)
        goals = self.stance.copy()
        for foot in range(2):
            self._solve(goals, foot, self.sole(foot).seen_from(base))
        if aim.flying is not None:
            self._fly(goals, aim.flying, aim.standing)
        block = self._hold.block.copy()
        np.clip(goals, self.joints.lower, self.joints.upper, out=block[0])
        block[1] = self._run_ahead(block[0], dt)
        torque = holding_torque(self.state, (1.0 - aim.right_load, aim.right_load))
        self._torque += min(dt / self.gains.slow, 1.0) * (torque - self._torque)
        block[2] = self._torque
        return JointCommand(block)

    def update(self, observation: Observation) -> None:
        """Measure the feet, the centre of mass and the base.

        Raises:
            StateMissingError: The observation has no base.
        """
        state = self.state.update(observation)
        self.places = ground_places(state.feet_position, state.feet_axes)
        self.mass, self.speed = state.com, state.com_velocity[:2]
        self.pose = state.pose
        rate = state.base.angular_velocity
        self._rate = self.pose.rotation @ rate * np.array([1.0, 1.0, 0.0])
        self.turned = float(heading(state.base.orientation))
        self.heights = state.feet_position[:, 2]
        self.ground = float(self.heights.min())

    def _base(self, aim: Aim, dt: float) -> Pose:
        """Return the desired pose of the base for `aim`, with PID feedback of CoM and tilt."""
        gains = self.gains
        error, slow = aim.com - self.mass[:2], self.speed - aim.speed
        self._shift = np.clip(self._shift + gains.follow * dt * error, -MOST_SHIFT, MOST_SHIFT)
        wanted = turn(aim.yaw)
        lean = turn_between(self.pose.rotation, wanted)
        self._tilt = np.clip(self._tilt + gains.follow * dt * lean, -MOST_TILT, MOST_TILT)
        offset = wanted @ self.pose.rotation.T @ (self.pose.position - self.mass)
        place = aim.com + offset[:2] + self._shift + gains.hold * error - gains.brake * slow
        tilt = self._tilt + gains.level * lean - gains.steady * self._rate
        return Pose(np.array([*place, self.ground + aim.height]), _small(tilt) @ wanted)

    def _run_ahead(self, goals: Array, dt: float) -> Array:
        """Return the filtered velocity (n,) of the goals, rad/s: feedforward against servo lag."""
        if self._before is not None:
            speed = (goals - self._before) / dt
            self._lead += min(dt / SMOOTH, 1.0) * (np.clip(speed, -FAST, FAST) - self._lead)
        self._before = goals.copy()
        return self._lead

    def _fly(self, goals: Array, foot: int, standing: float) -> None:
        """Set the swing leg, solved from the measured base; blend with its stance solution."""
        limb = self.limbs[foot]
        stood = goals[limb.joints].copy()
        self._solve(goals, foot, self.flying(foot).seen_from(self.pose))
        goals[limb.joints] += standing * (stood - goals[limb.joints])

    def _solve(self, goals: Array, foot: int, target: Pose) -> None:
        limb = self.limbs[foot]
        angles = limb.solve(target, self._last[foot], ITERATIONS)
        self._last[foot][limb.joints] = angles
        goals[limb.joints] = angles


def _small(turned: Array) -> Array:
    """Return the rotation matrix (3, 3) of a small rotation vector (3,) rad."""
    x, y, z = turned
    matrix = np.array([[1.0, -z, y], [z, 1.0, -x], [-y, x, 1.0]])
    q, r = np.linalg.qr(matrix)
    return q * np.sign(np.diag(r))
