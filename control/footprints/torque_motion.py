"""A body that stands, and swings one end at a time, with torques from whole-body control.

Wu & Zordan 2010: two curves (section 5) say where the centre of mass and the swing foot should be,
and the whole-body optimisation makes accelerations of that, at its own rate; inverse dynamics makes
torques of these at every tick. Who decides which end goes where says so in `_decide`.
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
"""Of the optimisation, s."""
COM_GAIN, COM_DAMPING = 40.0, 12.0
"""k_L, 1/s2, and d_L, 1/s, of Eq. 10."""
POSE_GAIN, POSE_DAMPING = 100.0, 20.0
"""k_T and d_T of Eq. 9."""
SWING_GAIN, SWING_DAMPING = 900.0, 60.0
"""The same of the swing foot, and of the attitude of the trunk a third of it."""
SPIN_DAMPING = 5.0
"""d_z of Eq. 11, 1/s."""
STILL_DAMPING = 20.0
"""Damping of a standing foot, 1/s."""
FOLLOW_DAMPING = 2.0
"""Damping of every joint about the speed that was planned, N m s/rad."""


@dataclass
class Swing:
    """A step under way.

    Attributes:
        foot: Which end.
        began: When, s.
        duration: How long, s.
        start: Pose of its sole when it began, (3,) m.
        yaw: Headings of it, from and to, rad.
        target: (2,) m.
        com: (2,) where the centre of mass was, m.
    """

    foot: int
    began: float
    duration: float
    start: Array
    yaw: tuple[float, float]
    target: Array
    com: Array


class TorqueMotion(ABC):
    """What every controller of a robot with torque joints does, however it decides.

    Args:
        joints: The robot's joints.
        body: Its whole-body control.
        stance: (n,) rad, the pose to stand in.
        height: How high an end is lifted, m.
    """

    def __init__(self, joints: Joints, body: WholeBody, stance: Array, height: float) -> None:
        self._joints, self._body, self.dynamics = joints, body, body.dynamics
        self._stance, self._lifted = stance, height
        self._swing: Swing | None = None

    def reset(self, observation: Observation) -> None:
        """Begin to stand; the robot is in its stance."""
        self.dynamics.update(observation)
        self._swing = None
        self._height = float(self.dynamics.momenta.com[2])
        self._due = observation.time
        self._plan: Plan | None = None

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the torques of now.

        Raises:
            StateMissingError: The observation has no base.
            WindupError: The optimisation found no answer.
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
            # A light foot runs away between two plans where it meets ground that was not expected.
            damping=FOLLOW_DAMPING,
        )

    @abstractmethod
    def _decide(self, now: float) -> None:
        """Go over to what comes next where it is time: lift an end, aim it anew, put it down."""

    @abstractmethod
    def _com_aim(self, now: float) -> Array:
        """Return where (2,) m the centre of mass should be."""

    def _lift(self, foot: int, target: Array, yaw: float, duration: float, now: float) -> None:
        """Begin to swing an end to a target (2,) m and a heading, rad."""
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
        """The places (2, 3), x m, y m, yaw rad, where the feet are now."""
        ends = self.dynamics.ends
        frames = np.array([end.rotation.ravel() for end in ends])
        return ground_places(np.array([end.position for end in ends]), frames)

    def _middle(self, foot: int) -> Array:
        """Return (2,) m, the middle of a sole on the ground."""
        return np.asarray(self.dynamics.ground(foot)[:, :2].mean(axis=0))

    def _objectives(self, now: float) -> Objectives:
        """Return what the body should do now."""
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
        """Return where (3,) m the sole should be, and its heading, rad."""
        part = (now - swing.began) / swing.duration
        way = gaussian_progress(part)
        at = swing.start.copy()
        at[:2] += way * (swing.target - swing.start[:2])
        at[2] = (1.0 - way) * swing.start[2] + lift(part, self._lifted)
        at[2] -= max(part - 1.0, 0.0) * self._lifted  # and on, until it meets the ground
        left = wrapped(swing.yaw[1] - swing.yaw[0])
        return at, swing.yaw[0] + way * left

    def _trunk_rate(self) -> Array:
        """Return the angular acceleration (3,) that turns the base upright, as the feet stand."""
        yaws = [yaw_of(end.rotation) for end in self.dynamics.ends]
        half = 0.5 * wrapped(yaws[1] - yaws[0])
        base = self.dynamics.base.rotation
        error = base.T @ turn_between(base, turn(yaws[0] + half))  # seen from the base
        return POSE_GAIN * error - POSE_DAMPING * self.dynamics.velocity[3:6]
