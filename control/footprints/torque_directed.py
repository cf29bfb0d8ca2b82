"""Walks footprints with torques from whole-body control, one step after the other.

Wu & Zordan 2010, sections 4 and 5: somebody says where the foot comes down. The weight goes over
the foot that stays before the other one is lifted, so that every step begins and ends at rest.
"""

from collections.abc import Sequence
from math import sqrt
from typing import Literal

import numpy as np

from windup.control.footprints.directed_file import Directed
from windup.control.footprints.footprints import Footprint, between, onto
from windup.control.footprints.swing import smooth_progress
from windup.control.footprints.torque_motion import PERIOD, TorqueMotion
from windup.control.whole_body.whole_body import WholeBody
from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation

Phase = Literal["rest", "shift", "swing", "land"]
PEAK = 5.77
"""Largest acceleration on a way of 1 that takes 1, of `smooth_progress`."""
LATE = 2.0
"""After so many times its duration a swing is over, whether the foot touches or not."""


class TorqueDirected(TorqueMotion):
    """Takes the steps of a list of footprints, and comes to rest between the feet.

    Args:
        joints: The robot's joints.
        body: Its whole-body control.
        stance: (n,) rad, the pose to start from.
        prints: What to do.
        how: Times.
        contacts: The feet's sensors, which tell that one has come down; heights above the ground
            are too rough for that where the state is estimated.

    Attributes:
        finished: All steps are done and the weight is between the feet.
        landed: How many feet have come down.
        stood: How many of these have borne the weight since, as they were told.
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
        """Begin where the feet are."""
        super().reset(observation)
        self._origin = between(*self.places)
        self.finished, self.landed, self.stood = False, 0, 0
        self._enter("rest", observation.time)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the torques of now; see `TorqueMotion.step`."""
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
        """Go on, with the weight where it should be."""
        self.stood = self.landed
        if self.landed == len(self.prints):
            self.finished = True
        elif self._phase == "rest":
            self._enter("shift", now)
        else:
            self._step(self.prints[self.landed], now)

    def _step(self, one: Footprint, now: float) -> None:
        """Lift a foot to its footprint."""
        seen = self._origin if one.frame == "start" else self.places[1 - one.foot]
        x, y, yaw = onto(seen, one.place)
        self._lift(one.foot, np.array([x, y]), yaw, one.duration or self.how.swing, now)
        self._enter("swing", now)

    def _fly(self, now: float) -> None:
        """Put the foot down when it is there."""
        swing = self._flying
        part = (now - swing.began) / swing.duration
        if part >= LATE or (part >= 1.0 and self._down[swing.foot]):
            self._swing = None
            self.landed += 1
            self._enter("land", now)

    def _calm(self) -> bool:
        """The weight is where it should be, and rests."""
        momenta = self.dynamics.momenta
        away = np.hypot(*(momenta.com[:2] - self._goal()))
        return bool(away < self.how.near and np.hypot(*momenta.velocity[:2]) < self.how.quiet)

    def _goal(self) -> Array:
        """Return where (2,) m the weight should go: over the foot that stays, or between both."""
        if self._phase == "rest":
            return 0.5 * (self._middle(0) + self._middle(1))
        at = self.landed - (self._phase == "land")
        return self._middle(1 - self.prints[at].foot)

    def _com_rate(self, now: float) -> Array:
        """Add the acceleration of the curve, which is smooth here (Eq. 10)."""
        before, aim, after = (self._com_aim(now + k * PERIOD) for k in (-1, 0, 1))
        rate = super()._com_rate(now)
        rate[:2] += (after - 2.0 * aim + before) / PERIOD**2
        return rate

    def _com_aim(self, now: float) -> Array:
        if self._phase in ("swing", "land"):
            return self._goal()
        part = smooth_progress((now - self._since) / self._seconds)
        return np.asarray(self._began + part * (self._goal() - self._began))
