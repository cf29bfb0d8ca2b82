"""Walks footprints with torques from whole-body control, one step after the other.

Wu & Zordan 2010, sections 4 and 5, with given footprints. The weight shifts over the stance foot
before the other one is lifted, so that every step begins and ends at rest.
"""

from collections.abc import Sequence
from math import sqrt
from typing import Literal

import numpy as np

from windup.control.execution.swing import smooth_progress
from windup.control.footprints.directed_file import Directed
from windup.control.footprints.footprints import Footprint
from windup.control.footprints.torque_motion import PERIOD, TorqueMotion
from windup.control.kinematics.places import between, onto
from windup.control.whole_body.whole_body import WholeBody
from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

Phase = Literal["rest", "shift", "swing", "land"]
PEAK = 5.77
"""Peak acceleration of `smooth_progress`, for a path of length 1 in time 1."""
LATE = 2.0
"""Time-out of a swing, in multiples of its duration; it then ends even without contact."""


class TorqueDirected(TorqueMotion):
    """Controller that walks a list of footprints and ends with the weight between the feet.

    Args:
        joints: The robot's joints.
        body: The robot's whole-body control.
        stance: (n,) rad, the pose to start from.
        prints: Footprints to walk, in order.
        how: Times and tolerances.
        contacts: The feet's contact sensors, which detect touchdown; an estimated state gives
            heights above the ground that are too inaccurate for that.

    Attributes:
        finished: All steps are done and the weight is between the feet.
        landed: Number of steps whose foot has come down.
        stood: Number of steps after which the following weight shift has ended.
    """

    def __init__(
        self,
        joints: Joints,
        body: WholeBody,
        stance: Array,
        prints: Sequence[Footprint],
        how: Directed,
        contacts: ContactSensors,
    ) -> None:
        super().__init__(joints, body, stance, how.lift)
        self.prints, self.how, self._contacts = prints, how, contacts
        self.finished, self.landed, self.stood = False, 0, 0

    def reset(self, observation: Observation) -> None:
        """Start from the measured places of the feet."""
        super().reset(observation)
        self._origin = between(*self.places)
        self.finished, self.landed, self.stood = False, 0, 0
        self._enter("rest", observation.time)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of this tick; see `TorqueMotion.step`."""
        self._down = self._contacts.feet_down(observation.contacts)
        return super().step(observation, dt)

    def _enter(self, phase: Phase, now: float) -> None:
        self._phase, self._since = phase, now
        if phase in ("shift", "rest"):
            self._began = self.dynamics.momenta.com[:2].copy()
            far = float(np.hypot(*(self._goal() - self._began)))
            self._seconds = max(self.how.shift, sqrt(PEAK * far / self.how.pace))

    def _decide(self, now: float) -> None:
        gone = now - self._since
        if self._phase == "swing":
            self._fly(now)
        elif self._phase == "land":
            if gone >= self.how.land:
                self._enter("shift" if self.landed < len(self.prints) else "rest", now)
        elif gone >= self._seconds and (self._calm() or gone > self.how.patience * self._seconds):
            self._rested(now)

    def _rested(self, now: float) -> None:
        """Enter the next phase after a completed weight shift, or finish."""
        self.stood = self.landed
        if self.landed == len(self.prints):
            self.finished = True
        elif self._phase == "rest":
            self._enter("shift", now)
        else:
            self._step(self.prints[self.landed], now)

    def _step(self, one: Footprint, now: float) -> None:
        """Start the swing of a foot to its footprint."""
        seen = self._origin if one.frame == "start" else self.places[1 - one.foot]
        x, y, yaw = onto(seen, one.place)
        self._lift(one.foot, np.array([x, y]), yaw, one.duration or self.how.swing, now)
        self._enter("swing", now)

    def _fly(self, now: float) -> None:
        """End the swing on touchdown after its duration, or on its time-out."""
        swing = self._flying
        part = (now - swing.began) / swing.duration
        if part >= LATE or (part >= 1.0 and self._down[swing.foot]):
            self._swing = None
            self.landed += 1
            self._enter("land", now)

    def _calm(self) -> bool:
        """Return True if the CoM is at its goal and at rest, within the tolerances."""
        momenta = self.dynamics.momenta
        away = np.hypot(*(momenta.com[:2] - self._goal()))
        return bool(away < self.how.near and np.hypot(*momenta.velocity[:2]) < self.how.quiet)

    def _goal(self) -> Array:
        """Return the goal (2,) m of the CoM: over the stance foot, or between both feet."""
        if self._phase == "rest":
            return 0.5 * (self._middle(0) + self._middle(1))
        at = self.landed - (self._phase == "land")
        return self._middle(1 - self.prints[at].foot)

    def _com_rate(self, now: float) -> Array:
        """Return the CoM acceleration (Eq. 10) with the curve's own, which is smooth here."""
        before, aim, after = (self._com_aim(now + k * PERIOD) for k in (-1, 0, 1))
        rate = super()._com_rate(now)
        rate[:2] += (after - 2.0 * aim + before) / PERIOD**2
        return rate

    def _com_aim(self, now: float) -> Array:
        if self._phase in ("swing", "land"):
            return self._goal()
        part = smooth_progress((now - self._since) / self._seconds)
        return np.asarray(self._began + part * (self._goal() - self._began))
