"""Walks footprints with position servos, quasi-statically: first the weight shifts, then a foot.

Each phase is planned from the measured places of the feet, so that errors do not accumulate.
"""

from collections.abc import Sequence
from typing import Literal

import numpy as np

from windup.control.footprints.directed_file import ServoDirected
from windup.control.footprints.footprints import Footprint, between, onto, seen_from
from windup.control.footprints.leg_motion import PRESS, TAKE_OFF, Aim, LegMotion
from windup.control.footprints.swing import gaussian_progress, lift, smooth_progress
from windup.control.kinematics.limb_ik import LimbIk, Pose
from windup.control.kinematics.robot_state import RobotState
from windup.control.kinematics.rotation import turn, way_round
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

Phase = Literal["shift", "swing", "land", "rest"]


class FootprintWalker(LegMotion):
    """Controller that walks a list of footprints and ends with the weight between the feet.

    Args:
        joints: The robot's joints.
        state: The robot's state.
        limbs: Inverse kinematics of the two legs, in the order of the soles.
        stance: (n,) rad, the pose to start from; joints outside the legs keep it.
        prints: Footprints to walk, in order.
        how: Gains and times.

    Attributes:
        finished: All steps are done and the weight is between the feet.
        landed: Number of steps whose foot has come down.
        stood: Number of steps after which the following weight shift has ended.
        target: (3,) planned place of the current or last swing foot, relative to the stance foot.
    """

    target: Array

    def __init__(
        self,
        joints: Joints,
        state: RobotState,
        limbs: Sequence[LimbIk],
        stance: Array,
        prints: Sequence[Footprint],
        how: ServoDirected,
    ) -> None:
        super().__init__(joints, state, limbs, stance, how)
        self.prints, self.how = prints, how
        self.finished, self.landed, self.stood = False, 0, 0

    def reset(self, observation: Observation) -> None:
        """Start from the measured places of the feet."""
        super().reset(observation)
        self._origin = between(*self.places)
        self._apart = seen_from(*self.places)
        height = float(self.pose.position[2]) - self.ground
        self._aim = Aim(self.mass[:2].copy(), np.zeros(2), height, self.turned, 0.5)
        self.finished, self.landed, self.stood, self._foot = False, 0, 0, 0
        self._enter("rest", observation.time)

    def plan(self, now: float, dt: float) -> Aim:
        """Return the aim of this tick."""
        self._advance(now)
        part = self._now = min((now - self._began) / self._seconds(), 1.0)
        self._aim = self._between(part)
        if self._phase in ("swing", "land"):
            standing = part if self._phase == "land" else max(1.0 - part / TAKE_OFF, 0.0)
            self._aim.flying, self._aim.standing = self._foot, standing
        return self._aim

    def _between(self, part: float) -> Aim:
        """Return the aim at the fraction `part` (0 to 1) of the phase."""
        s = smooth_progress(part)
        pace = 30.0 * (part * (1.0 - part)) ** 2 / self._seconds()
        begin, end = self._from, self._to
        return Aim(
            com=begin.com + s * (end.com - begin.com),
            speed=pace * (end.com - begin.com),
            height=begin.height + s * (end.height - begin.height),
            yaw=begin.yaw + s * (end.yaw - begin.yaw),
            right_load=begin.right_load + s * (end.right_load - begin.right_load),
        )

    def _enter(self, phase: Phase, now: float) -> None:
        """Enter a phase, from the present aim to its goal."""
        self._phase, self._began = phase, now
        self._from = self._aim
        if phase == "shift":
            self._foot = self.prints[self.landed].foot
        if phase == "swing":
            self._fix()
        if phase == "land":
            stance = self.places[1 - self._foot]
            there = onto(stance, self.target)
            pair = (there, stance) if self._foot == 0 else (stance, there)
            self._apart = seen_from(*pair)
        self._to = self._goal(phase)

    def _fix(self) -> None:
        """Set the start and target place of the swing foot, relative to the stance foot."""
        wanted = self.prints[self.landed]
        stance = self.places[1 - self._foot]
        self._left = seen_from(stance, self.places[self._foot])
        self.target = wanted.place
        if wanted.frame == "start":
            self.target = seen_from(stance, onto(self._origin, wanted.place))

    def _goal(self, phase: Phase) -> Aim:
        """Return the aim at the end of a phase."""
        middle, yaw = between(*self.places), self._aim.yaw
        if phase == "rest":
            yaw += way_round(yaw, middle[2])
            return Aim(middle[:2], np.zeros(2), self.how.height, yaw, 0.5)
        stance = self.places[1 - self._foot]
        if phase == "swing":
            yaw += way_round(yaw, between(stance, onto(stance, self.target))[2])
        share = float(1 - self._foot)
        return Aim(stance[:2].copy(), np.zeros(2), self.how.height, yaw, share)

    def _seconds(self) -> float:
        if self._phase == "swing":
            return self.prints[self.landed].duration or self.how.swing
        return self.how.land if self._phase == "land" else self.how.shift

    def _advance(self, now: float) -> None:
        """Enter the next phase if the present one is over."""
        if now - self._began < self._seconds() - 1e-9 or self.finished:
            return
        if self._phase in ("shift", "rest"):
            self.stood = self.landed
        if self._phase == "shift":
            if self._calm() or now - self._began > self.how.patience * self._seconds():
                self._enter("swing", now)
        elif self._phase == "swing":
            self._enter("land", now)
        elif self._phase == "land":
            self.landed += 1
            self._enter("shift" if self.landed < len(self.prints) else "rest", now)
        elif self.landed < len(self.prints):
            self._enter("shift", now)
        else:
            self.finished = True

    def _calm(self) -> bool:
        """Return True if the CoM is over the stance foot and at rest, within the tolerances."""
        away = np.hypot(*(self.mass[:2] - self._to.com))
        return bool(away < self.how.near and np.hypot(*self.speed) < self.how.quiet)

    def sole(self, foot: int) -> Pose:
        """Return the desired pose of a sole on the ground.

        The more loaded sole keeps its measured place. The other one is held at the distance at
        which it came down: otherwise small forces between the feet would make it creep.
        """
        x, y, yaw = self.places[foot] + self._creep(foot)
        return Pose(np.array([x, y, self.ground]), turn(yaw))

    def _creep(self, foot: int) -> Array:
        """Return the correction (3,) of a foot on the ground against creep, m and rad."""
        one, other = self.places
        share = self._aim.right_load
        if self._phase == "swing":
            return np.zeros(3)
        if foot == 1:
            away = onto(one, self._apart) - other
            return (1.0 - share) * np.array([*away[:2], way_round(0.0, away[2])])
        back = seen_from(onto(np.zeros(3), self._apart), np.zeros(3))
        away = onto(other, back) - one
        return share * np.array([*away[:2], way_round(0.0, away[2])])

    def flying(self, foot: int) -> Pose:
        """Return the desired pose of the swing foot's sole."""
        stance = self.places[1 - foot]
        if self._phase == "land":
            x, y, yaw = onto(stance, self.target)
            return Pose(np.array([x, y, self.ground - PRESS]), turn(yaw))
        s = gaussian_progress(self._now)
        x, y, yaw = onto(stance, self._left + s * (self.target - self._left))
        return Pose(np.array([x, y, self.ground + lift(self._now, self.how.lift)]), turn(yaw))
