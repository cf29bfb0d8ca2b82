"""A comfort step: a robot that stands still puts one foot back to its place in the stance."""

from typing import Literal

import numpy as np

from windup.control.execution.executor import StepExecutor
from windup.control.execution.motion import Motion, Shift, Swing, shift_time
from windup.control.kinematics.momenta import capture_point
from windup.control.kinematics.rotation import turn, way_round
from windup.control.stepping.stepping_file import ComfortTable, Stepping
from windup.hal.joints import Array

STILL = 0.05
"""Maximum speed of the centre of mass of a robot that stands still, m/s."""
LATE = 2.0
"""Time-out of the touchdown, in multiples of the swing's duration."""

Phase = Literal["shift", "swing", "back"]


class ComfortStep:
    """Shifts the weight to one foot, puts the other back beside it, and shifts the weight back.

    Kenwright 2012, section IV: after a disturbance people return to a relaxed stance, in position
    and direction, by steps that are not necessary to prevent a fall.

    Args:
        executor: The executor of a robot that stands still.
        now: Present time, s.
        stepping: Stepping parameters of the robot.

    Attributes:
        foot: Index of the foot that steps: the one that has to move further forward.
        target: (2,) its nominal place beside the other one, m.
        needed: It is too far from that place, or turned too far relative to the other foot.
        given_up: The CoM did not come over the stance foot in time.
        motion: What the robot should do.
    """

    def __init__(self, executor: StepExecutor, now: float, stepping: Stepping) -> None:
        self._executor, self._lift = executor, stepping.lift
        self._how: ComfortTable = stepping.relax
        planted = executor.feet.planted()
        aside = [self._home(foot, planted.yaws) - executor.feet.places[foot] for foot in (0, 1)]
        # Both errors are about equal; the foot that steps forward leaves the other in front.
        forward = turn(planted.front)[:2, 0]
        self.foot = int(np.argmax([way @ forward for way in aside]))
        self.target = self._home(self.foot, planted.yaws)
        far = float(np.linalg.norm(aside[self.foot]))
        askew = abs(way_round(*planted.yaws))
        self.needed = far > stepping.comfort or askew > self._how.askew
        self.given_up = False
        yaw = executor.feet.yaw
        self._phase: Phase = "shift"
        self._yaws = yaw, float(planted.yaws[1 - self.foot])
        self._place = executor.weight
        self._over = executor.over(1 - self.foot)
        self.motion = Motion(planted, self._shift(self._over, now), yaw=(yaw, yaw))

    def done(self, now: float) -> bool:
        """Return whether the step is over or given up, with the weight shifted back."""
        return self._phase == "back" and now - self._began >= self.motion.shift.seconds

    def advance(self, now: float) -> None:
        """Enter the next phase if it is due: swing once the other foot can bear the robot."""
        gone, shift = now - self._began, self.motion.shift
        if self._phase == "shift":
            if gone >= self._how.least * shift.seconds and self._borne():
                self._swing(now)
            elif gone > shift.seconds + self._how.wait:
                self.given_up = True
                self._back(now)
        elif self._phase == "swing" and gone > shift.seconds and self._landed(gone / shift.seconds):
            self._land(now)
        self._place = self.motion.shift.at(now)

    @property
    def _began(self) -> float:
        return self.motion.shift.began

    def _borne(self) -> bool:
        """Return whether CoM and capture point are inside the sole of the stance foot."""
        feet = self._executor.feet
        sole, momenta = feet.support((1 - self.foot,)), feet.momenta
        return min(sole.margin(capture_point(momenta)), sole.margin(momenta.com)) > self._how.inside

    def _landed(self, part: float) -> bool:
        """Return whether the foot has come down, or is late at `part` of the swing's duration."""
        return self._executor.touches(self.foot) or part > LATE

    def _swing(self, now: float) -> None:
        """Start the swing; meanwhile the weight comes all the way over the other foot."""
        motion, how, before = self.motion, self._how, self._yaws[0]
        start = self._executor.lift_off(self.foot, motion.planted)
        yaws = float(motion.planted.yaws[self.foot]), self._yaws[1]
        motion.shift = Shift(
            self._place, self._over, now, how.swing, self._executor.ease, smooth=True
        )
        motion.swing = Swing(
            self.foot, now, how.swing, start, self.target, yaws, self._lift, self._place
        )
        motion.yaw, self._phase = (before, self._yaws[1]), "swing"

    def _land(self, now: float) -> None:
        """Plant the foot at its target, and shift the weight back from where it is measured.

        It may not have come all the way over the other foot.
        """
        self._place = self._executor.weight
        self.motion.planted = self.motion.planted.step(self.foot, self.target, self._yaws[1])
        self._back(now)

    def _back(self, now: float) -> None:
        """Start to shift the weight back between the feet."""
        planted = self.motion.planted
        self.motion.shift = self._shift(self._executor.home(planted), now)
        self.motion.swing, self.motion.yaw = None, (planted.front, planted.front)
        self._phase = "back"

    def _shift(self, goal: Array, now: float) -> Shift:
        """Return the path of the weight from its present place to `goal` (2,)."""
        far = float(np.linalg.norm(goal - self._place))
        seconds = shift_time(far, self._how.shift, self._how.pace)
        return Shift(self._place, goal, now, seconds, self._executor.ease, smooth=True)

    def _home(self, foot: int, yaws: Array) -> Array:
        """Return the nominal place (2,) m of a foot, relative to where the other one stands."""
        feet, other = self._executor.feet, 1 - foot
        way = turn(yaws[other])[:2, :2] @ (feet.homes[foot] - feet.homes[other])[:2]
        return np.asarray(feet.places[other] + way)
