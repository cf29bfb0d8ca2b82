"""Comfort steps with torques: a foot goes back beside the other one, as a footprint is walked.

Kenwright 2012, section IV: after a disturbance people return to a relaxed stance by steps that no
fall forces on them, in position and direction.
"""

from collections.abc import Callable

import numpy as np

from windup.control.footprints.footprints import Footprint, onto, seen_from
from windup.control.footprints.torque_directed import TorqueDirected
from windup.control.kinematics.momenta import capture_point
from windup.control.kinematics.support import SupportRegion
from windup.control.stepping.comfort import ASKEW
from windup.hal.joints import Array


class ComfortWalk(TorqueDirected):
    """Walks one footprint, unless the legs are too short to come over the foot that stays.

    Attributes:
        given_up: They are.
    """

    given_up = False

    def _rested(self, now: float) -> None:
        if self._phase == "shift":
            sole = SupportRegion.hull(self.dynamics.ground(1 - self.prints[0].foot))
            if sole.margin(capture_point(self.dynamics.momenta)) < 0.0:
                self.finished = self.given_up = True
                return
        super()._rested(now)


Walk = Callable[[Footprint], ComfortWalk]
Allows = Callable[[int, float, Array, Array], bool]


class TorqueComfort:
    """Knows where the feet stand in the stance, and which step brings them back to it.

    Args:
        walk: Makes what walks one footprint.
        most: How far a foot may stand from its place beside the other one, m.
    """

    def __init__(self, walk: Walk, most: float) -> None:
        self.walk, self._most = walk, most

    def reset(self, places: Array) -> None:
        """Take the places (2, 3), x m, y m, yaw rad, of the feet in the stance."""
        self._homes = [seen_from(places[1 - foot], places[foot]) for foot in (0, 1)]

    def needed(self, places: Array, allows: Allows) -> Footprint | None:
        """Return the step that is missing to the stance, if there is one.

        Args:
            places: (2, 3) where the feet are.
            allows: Tells whether a foot, of a heading, rad, may go from here to there, (2,) m.
        """
        targets = [onto(places[1 - foot], self._homes[foot]) for foot in (0, 1)]
        aside = [target - place for target, place in zip(targets, places, strict=True)]
        # Both miss by about as much; the one that has to go forward leaves the other in front.
        yaw = places[:, 2].mean()
        foot = int(np.argmax([way[:2] @ [np.cos(yaw), np.sin(yaw)] for way in aside]))
        turned = seen_from(targets[foot], places[foot])[2]
        if np.hypot(*aside[foot][:2]) <= self._most and abs(turned) <= ASKEW:
            return None
        if not allows(foot, float(targets[foot][2]), places[foot, :2], targets[foot][:2]):
            return None
        return Footprint(foot, self._homes[foot])
