"""Slow steps to footprints on position servos: the weight shifts, then a foot swings.

Each phase is tracked relative to the measured places of the feet, so that errors do not accumulate.
"""

import numpy as np

from windup.control.execution.leg_motion import PRESS, TAKE_OFF, Aim, LegMotion
from windup.control.execution.motion import Planted, WalkMotion
from windup.control.execution.swing import gaussian_progress, lift, smooth_progress
from windup.control.kinematics.limb_ik import Pose
from windup.control.kinematics.places import onto, seen_from
from windup.control.kinematics.rotation import turn, way_round
from windup.hal.command import JointCommand
from windup.hal.joints import Array
from windup.hal.observation import Observation


class LegExecutor(LegMotion):
    """Realises slow steps with the joint angles of both legs, and torques against gravity.

    `LegMotion` has its arguments.
    """

    _motion: WalkMotion
    follows_feet = False

    def observe(self, observation: Observation) -> None:
        """Measure the robot; see `Executor.observe`."""
        self.update(observation)

    def due(self, now: float, dt: float) -> bool:
        """Return True: joint angles are computed at every tick."""
        return True

    def touches(self, foot: int) -> bool:
        """Return True: the servos press the foot down, and no bus carries foot switches."""
        return True

    @property
    def com(self) -> Array:
        """(2,) measured position of the centre of mass, m."""
        return self.mass[:2]

    @property
    def com_velocity(self) -> Array:
        """(2,) measured velocity of the centre of mass, m/s."""
        return self.speed

    @property
    def yaw(self) -> float:
        """Measured heading of the base, rad."""
        return self.turned

    @property
    def height(self) -> float:
        """Measured height of the base above the lower sole, m."""
        return float(self.pose.position[2]) - self.ground

    def middle(self, foot: int) -> Array:
        """Return the middle (2,) of a sole on the ground, m: its site is there."""
        return np.asarray(self.places[foot, :2])

    def lift_off(self, foot: int, planted: Planted) -> Array:
        """Return the measured position (3,) of the site of a sole, m."""
        return self.state.feet_position[foot]

    def realise(self, motion: WalkMotion, now: float, dt: float) -> JointCommand:
        """Return the command of this tick."""
        self._motion = motion
        return self.command(self.plan(now, dt), dt)

    def plan(self, now: float, dt: float) -> Aim:
        """Return the desired state of this tick."""
        motion, shift = self._motion, self._motion.shift
        part = self._part = shift.part(now)
        s = smooth_progress(part)
        pace = 30.0 * (part * (1.0 - part)) ** 2 / shift.seconds
        yaw = motion.yaw or (0.0, 0.0)
        self._load = motion.load[0] + s * (motion.load[1] - motion.load[0])
        aim = Aim(
            com=shift.start + s * (shift.goal - shift.start),
            speed=pace * (shift.goal - shift.start),
            height=motion.height[0] + s * (motion.height[1] - motion.height[0]),
            yaw=yaw[0] + s * (yaw[1] - yaw[0]),
            right_load=self._load,
        )
        if motion.phase in ("swing", "land"):
            takes_off = max(1.0 - part / TAKE_OFF, 0.0)
            aim.flying, aim.standing = motion.foot, part if motion.phase == "land" else takes_off
        return aim

    def sole(self, foot: int) -> Pose:
        """Return the desired pose of a sole on the ground.

        The more loaded sole keeps its measured place. The other one is held at the distance at
        which it came down: otherwise small forces between the feet would make it creep.
        """
        x, y, yaw = self.places[foot] + self._creep(foot)
        return Pose(np.array([x, y, self.ground]), turn(yaw))

    def _creep(self, foot: int) -> Array:
        """Return the correction (3,) of a foot on the ground against creep, m and rad."""
        (one, other), apart, share = self.places, self._motion.apart, self._load
        if self._motion.phase == "swing":
            return np.zeros(3)
        if foot == 1:
            away = onto(one, apart) - other
            return (1.0 - share) * np.array([*away[:2], way_round(0.0, away[2])])
        back = seen_from(onto(np.zeros(3), apart), np.zeros(3))
        away = onto(other, back) - one
        return share * np.array([*away[:2], way_round(0.0, away[2])])

    def flying(self, foot: int) -> Pose:
        """Return the desired pose of the swing foot's sole."""
        motion, stance = self._motion, self.places[1 - foot]
        if motion.phase == "land":
            x, y, yaw = onto(stance, motion.target)
            return Pose(np.array([x, y, self.ground - PRESS]), turn(yaw))
        s = gaussian_progress(self._part)
        x, y, yaw = onto(stance, motion.left + s * (motion.target - motion.left))
        up = 0.0 if motion.swing is None else lift(self._part, motion.swing.height)
        return Pose(np.array([x, y, self.ground + up]), turn(yaw))
