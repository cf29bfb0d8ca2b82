"""Steps with torques from whole-body control, on the feet or on the hands.

Wu & Zordan 2010: two curves (section 5) give the desired centre of mass and swing foot; the
whole-body optimisation computes accelerations from them every `period`, and inverse dynamics
computes torques from these at every tick.
"""

import numpy as np

from windup.control.execution.motion import Motion, Planted, Swing
from windup.control.execution.swing import smooth_progress
from windup.control.execution.torque_feet import TorqueFeet
from windup.control.kinematics.places import ground_places
from windup.control.kinematics.robot_state import RobotState
from windup.control.kinematics.rotation import turn, turn_between, yaw_of
from windup.control.whole_body.whole_body import Objectives, Plan, WholeBody
from windup.control.whole_body.whole_body_file import WholeBodyFile
from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.geometry.angles import wrapped
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

TAKE = 0.6
"""Time after a takeover in which the height and the posture change to those of the stance, s."""


class TorqueExecutor:
    """Realises motions with joint torques, and damping about the planned velocities.

    Args:
        joints: The robot's joints.
        body: The robot's whole-body control.
        stance: (n,) rad, the pose to stand in.
        contacts: The feet's contact sensors: an estimated state gives heights above the ground that
            are too inaccurate for a slow touchdown.
        how: Gains.

    Attributes:
        feet: The robot's feet.
        state: The robot's state.
        follows_feet: The goal of the weight follows the feet; see `WalkExecutor`.
    """

    follows_feet = True

    def __init__(
        self,
        joints: Joints,
        body: WholeBody,
        stance: Array,
        contacts: ContactSensors,
        how: WholeBodyFile,
    ) -> None:
        self._joints, self._body, self.stance = joints, body, stance
        self.dynamics, self._contacts, self._how = body.dynamics, contacts, how
        self.feet = TorqueFeet(body.dynamics, stance, how.touch)
        self.state: RobotState = body.dynamics.state
        self._plan: Plan | None = None

    def reset(self, observation: Observation) -> None:
        """Start in the stance, whose height is the measured one; see `Executor.reset`."""
        self.observe(observation)
        self._taken, self._due = -np.inf, observation.time
        self._before = self.stance
        self._above = self._tall = float(self.feet.momenta.com[2])
        self._plan = None

    def take(self, observation: Observation) -> None:
        """Start from any state; the height and the posture come to the stance in `TAKE` s."""
        self.reset(observation)
        self._taken, self._before = observation.time, self.dynamics.position.copy()
        lowest = min(float(self.feet.ground(foot)[:, 2].min()) for foot in (0, 1))
        self._tall = lowest + self.feet.height

    def observe(self, observation: Observation) -> None:
        """Measure the robot; see `Executor.observe`."""
        self.feet.update(observation)
        self._touching = self._contacts.feet_down(observation.contacts)

    def due(self, now: float, dt: float) -> bool:
        """Return whether the optimisation is due in this tick."""
        if self._plan is not None and now < self._due - 0.5 * dt:
            return False
        self._due = max(self._due + self._how.period, now)
        self._plan = None
        return True

    def realise(self, motion: Motion, now: float, dt: float) -> JointCommand:
        """Return the torques of this tick; see `Executor.realise`."""
        plan = self._plan
        if plan is None:
            plan = self._plan = self._body.plan(self._objectives(motion, now))
            self._planned, self._speed = now, self.dynamics.velocity[6:].copy()
        return JointCommand.of(
            self._joints,
            position=self.stance,
            velocity=self._speed + (now - self._planned) * plan.acceleration[6:],
            torque=self._body.torque(plan),
            stiffness=0.0,
            damping=self._how.follow,
        )

    def touches(self, foot: int) -> bool:
        """Return whether the contact sensors of a foot bear load."""
        return bool(self._touching[foot])

    @property
    def weight(self) -> Array:
        """(2,) position of the centre of mass, m."""
        return self.feet.momenta.com[:2].copy()

    @property
    def com(self) -> Array:
        """(2,) position of the centre of mass, m."""
        return self.feet.momenta.com[:2]

    @property
    def com_velocity(self) -> Array:
        """(2,) velocity of the centre of mass, m/s."""
        return self.feet.momenta.velocity[:2]

    @property
    def places(self) -> Array:
        """(2, 3) measured places of the feet: x m, y m, yaw rad."""
        return ground_places(self.state.feet_position, self.state.feet_axes)

    @property
    def yaw(self) -> float:
        """Heading of the base, rad."""
        return self.feet.yaw

    @property
    def height(self) -> float:
        """Height of the base above the lower sole, m."""
        return float(self.dynamics.base.position[2] - self.state.feet_position[:, 2].min())

    def middle(self, foot: int) -> Array:
        """Return the middle (2,) of a sole on the ground, m."""
        return self.feet.middle(foot)

    def ease(self, part: float) -> float:
        """Return the fraction of a shift done at the fraction `part` of the time: minimum jerk."""
        return smooth_progress(part)

    def over(self, foot: int) -> Array:
        """Return the middle (2,) of a sole, m."""
        return self.feet.middle(foot)

    def home(self, planted: Planted) -> Array:
        """Return the middle (2,) between the soles as measured, m."""
        return np.asarray(0.5 * (self.feet.middle(0) + self.feet.middle(1)))

    def anchor(self, motion: Motion, now: float) -> Array:
        """Return the measured position (2,) of the centre of mass, m: its curve starts there."""
        return self.weight

    def lift_off(self, foot: int, planted: Planted) -> Array:
        """Return the measured position (3,) of the sole, m."""
        return self.feet.feet[foot].position

    def _objectives(self, motion: Motion, now: float) -> Objectives:
        """Return the objectives of the optimisation at `now`."""
        dynamics, swing, how = self.dynamics, motion.swing, self._how
        stance = [foot for foot in (0, 1) if swing is None or foot != swing.foot]
        velocity = dynamics.velocity
        still = [-how.still * (dynamics.jacobian(foot) @ velocity) for foot in stance]
        part = min((now - self._taken) / TAKE, 1.0)
        posture = self._before + part * (self.stance - self._before)
        joints = how.posture.stiffness * (posture - dynamics.position)
        return Objectives(
            com=self._com_rate(motion, now, part),
            angular=-how.spin * dynamics.momenta.angular,
            posture=joints - how.posture.damping * velocity[6:],
            trunk=self._trunk_rate(),
            stance=stance,
            stance_rate=still,
            swing=None if swing is None else (swing.foot, self._swing_rate(swing, now)),
        )

    def _com_rate(self, motion: Motion, now: float, part: float) -> Array:
        """Return the acceleration (3,) of the centre of mass (Eq. 10).

        Where the curve's own acceleration is smooth it is added.
        """
        body, shift, period = self.dynamics.momenta, motion.shift, self._how.period
        aim, ahead, speed = shift.at(now), shift.at(now + period), np.zeros(3)
        speed[:2] = (ahead - aim) / period
        height = self._above + part * (self._tall - self._above)
        error = np.array([*aim, height]) - body.com
        gains = self._how.com
        rate = np.asarray(gains.stiffness * error + gains.damping * (speed - body.velocity))
        if shift.smooth:
            rate[:2] += (ahead - 2.0 * aim + shift.at(now - period)) / period**2
        return rate

    def _swing_rate(self, swing: Swing, now: float) -> Array:
        """Return the acceleration (6,) of the swing foot along its curve (section 5.1)."""
        pose, period, gains = self.feet.feet[swing.foot], self._how.period, self._how.swing
        twist = self.dynamics.jacobian(swing.foot) @ self.dynamics.velocity
        at, yaw = swing.at(now)
        before, _ = swing.at(now - period)
        after, _ = swing.at(now + period)
        speed = (after - before) / (2.0 * period)
        force = (after - 2.0 * at + before) / period**2
        linear = force + gains.stiffness * (at - pose.position)
        linear += gains.damping * (speed - twist[:3])
        turned = turn_between(pose.rotation, turn(yaw))
        angular = gains.stiffness * turned - gains.damping * twist[3:]
        return np.concatenate((linear, angular))

    def _trunk_rate(self) -> Array:
        """Return the angular acceleration (3,) of the base toward upright and the feet's yaw."""
        yaws = [yaw_of(foot.rotation) for foot in self.feet.feet]
        half = 0.5 * wrapped(yaws[1] - yaws[0])
        base, gains = self.dynamics.base.rotation, self._how.posture
        error = base.T @ turn_between(base, turn(yaws[0] + half))  # in the base frame
        return gains.stiffness * error - gains.damping * self.dynamics.velocity[3:6]
