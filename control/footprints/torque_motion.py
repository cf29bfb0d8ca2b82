"""Base class of controllers that stand and swing one end at a time, with whole-body torques.

Wu & Zordan 2010: two curves (section 5) give the desired centre of mass and swing foot; the
whole-body optimisation computes accelerations from them every `PERIOD`, and inverse dynamics
computes torques from these at every tick. Subclasses decide in `_decide` which end swings where.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from windup.control.footprints.footprints import ground_places
from windup.control.footprints.swing import gaussian_progress, lift
from windup.control.kinematics.rotation import turn, turn_between, yaw_of
from windup.control.whole_body.whole_body import Objectives, Plan, WholeBody
from windup.hal.command import JointCommand
from windup.hal.geometry.angles import wrapped
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

PERIOD = 0.005
"""Period of the optimisation, s."""
COM_GAIN, COM_DAMPING = 40.0, 12.0
"""k_L, 1/s2, and d_L, 1/s, of Eq. 10."""
POSE_GAIN, POSE_DAMPING = 100.0, 20.0
"""k_T, 1/s2, and d_T, 1/s, of Eq. 9; also used for the attitude of the trunk."""
SWING_GAIN, SWING_DAMPING = 900.0, 60.0
"""Stiffness, 1/s2, and damping, 1/s, of the swing foot."""
SPIN_DAMPING = 5.0
"""d_z of Eq. 11, 1/s."""
STILL_DAMPING = 20.0
"""Damping of a stance foot, 1/s."""
FOLLOW_DAMPING = 2.0
"""Damping of every joint about its planned velocity, N m s/rad."""


@dataclass
class Swing:
    """The swing of one end (a foot or a hand).

    Attributes:
        foot: Index of the end.
        began: Start time, s.
        duration: Planned duration, s.
        start: (3,) position of the sole at the start, m.
        yaw: Headings of the sole at the start and at the target, rad.
        target: (2,) target of the sole, m.
        com: (2,) centre of mass at the start, m.
    """

    foot: int
    began: float
    duration: float
    start: Array
    yaw: tuple[float, float]
    target: Array
    com: Array


class TorqueMotion(ABC):
    """Controller of a robot with torque joints; subclasses decide on the steps.

    Args:
        joints: The robot's joints.
        body: The robot's whole-body control.
        stance: (n,) rad, the pose to stand in.
        height: Height to which an end is lifted, m.
    """

    def __init__(self, joints: Joints, body: WholeBody, stance: Array, height: float) -> None:
        self._joints, self._body, self.dynamics = joints, body, body.dynamics
        self._stance, self._lifted = stance, height
        self._swing: Swing | None = None

    def reset(self, observation: Observation) -> None:
        """Start standing; the robot must be in its stance."""
        self.dynamics.update(observation)
        self._swing = None
        self._height = float(self.dynamics.momenta.com[2])
        self._due = observation.time
        self._plan: Plan | None = None

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of this tick: torques, and damping about the planned velocities.

        Raises:
            StateMissingError: The observation has no base.
            WindupError: The optimisation found no solution.
        """
        now = observation.time
        self.dynamics.update(observation)
        if self._plan is None or now >= self._due - 0.5 * dt:
            self._due = max(self._due + PERIOD, now)
            self._decide(now)
            self._plan = self._body.plan(self._objectives(now))
            self._planned, self._speed = now, self.dynamics.velocity[6:].copy()
        return JointCommand.of(
            self._joints,
            position=self._stance,
            velocity=self._speed + (now - self._planned) * self._plan.acceleration[6:],
            torque=self._body.torque(self._plan),
            stiffness=0.0,
            # Without this, a light foot that meets unexpected ground speeds away between two plans.
            damping=FOLLOW_DAMPING,
        )

    @abstractmethod
    def _decide(self, now: float) -> None:
        """Enter the next phase if it is due: lift an end, change its target, or land it."""

    @abstractmethod
    def _com_aim(self, now: float) -> Array:
        """Return the desired position (2,) of the centre of mass, m."""

    def _lift(self, foot: int, target: Array, yaw: float, duration: float, now: float) -> None:
        """Start the swing of an end to a target (2,) m and a heading `yaw`, rad."""
        pose = self.dynamics.ends[foot]
        yaws = (yaw_of(pose.rotation), yaw)
        com = self.dynamics.momenta.com[:2].copy()
        self._swing = Swing(foot, now, duration, pose.position, yaws, target, com)

    @property
    def _flying(self) -> Swing:
        assert self._swing is not None
        return self._swing

    @property
    def places(self) -> Array:
        """Measured places (2, 3) of the feet: x m, y m, yaw rad."""
        ends = self.dynamics.ends
        frames = np.array([end.rotation.ravel() for end in ends])
        return ground_places(np.array([end.position for end in ends]), frames)

    def _middle(self, foot: int) -> Array:
        """Return the centre (2,) of a sole on the ground, m."""
        return self.dynamics.middle(foot)

    def _objectives(self, now: float) -> Objectives:
        """Return the objectives of the optimisation at `now`."""
        dynamics, swing = self.dynamics, self._swing
        stance = [foot for foot in (0, 1) if swing is None or foot != swing.foot]
        velocity = dynamics.velocity
        still = [-STILL_DAMPING * (dynamics.jacobian(foot) @ velocity) for foot in stance]
        posture = POSE_GAIN * (self._stance - dynamics.position) - POSE_DAMPING * velocity[6:]
        return Objectives(
            com=self._com_rate(now),
            angular=-SPIN_DAMPING * dynamics.momenta.angular,
            posture=posture,
            trunk=self._trunk_rate(),
            stance=stance,
            stance_rate=still,
            swing=None if swing is None else (swing.foot, self._swing_rate(swing, now)),
        )

    def _com_rate(self, now: float) -> Array:
        """Return the acceleration (3,) of the centre of mass (Eq. 10)."""
        body = self.dynamics.momenta
        aim, speed = self._com_aim(now), np.zeros(3)
        ahead = self._com_aim(now + PERIOD)
        speed[:2] = (ahead - aim) / PERIOD
        error = np.array([*aim, self._height]) - body.com
        return np.asarray(COM_GAIN * error + COM_DAMPING * (speed - body.velocity))

    def _swing_rate(self, swing: Swing, now: float) -> Array:
        """Return the acceleration (6,) of the swing foot along its curve (section 5.1)."""
        pose = self.dynamics.ends[swing.foot]
        twist = self.dynamics.jacobian(swing.foot) @ self.dynamics.velocity
        at, yaw = self._swing_aim(swing, now)
        before, _ = self._swing_aim(swing, now - PERIOD)
        after, _ = self._swing_aim(swing, now + PERIOD)
        speed = (after - before) / (2.0 * PERIOD)
        force = (after - 2.0 * at + before) / PERIOD**2
        linear = force + SWING_GAIN * (at - pose.position) + SWING_DAMPING * (speed - twist[:3])
        turned = turn_between(pose.rotation, turn(yaw))
        return np.concatenate((linear, SWING_GAIN * turned - SWING_DAMPING * twist[3:]))

    def _swing_aim(self, swing: Swing, now: float) -> tuple[Array, float]:
        """Return the desired position (3,) of the swinging sole, m, and its heading, rad."""
        part = (now - swing.began) / swing.duration
        way = gaussian_progress(part)
        at = swing.start.copy()
        at[:2] += way * (swing.target - swing.start[:2])
        at[2] = (1.0 - way) * swing.start[2] + lift(part, self._lifted)
        at[2] -= max(part - 1.0, 0.0) * self._lifted  # then further down until contact
        left = wrapped(swing.yaw[1] - swing.yaw[0])
        return at, swing.yaw[0] + way * left

    def _trunk_rate(self) -> Array:
        """Return the angular acceleration (3,) of the base toward upright and the feet's yaw."""
        yaws = [yaw_of(end.rotation) for end in self.dynamics.ends]
        half = 0.5 * wrapped(yaws[1] - yaws[0])
        base = self.dynamics.base.rotation
        error = base.T @ turn_between(base, turn(yaws[0] + half))  # in the base frame
        return POSE_GAIN * error - POSE_DAMPING * self.dynamics.velocity[3:6]
