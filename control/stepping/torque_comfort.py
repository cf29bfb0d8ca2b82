"""Comfort steps with torques: a foot is put back beside the other one, as a single footprint.

Kenwright 2012, section IV: after a disturbance people return to a relaxed stance, in position and
direction, by steps that are not necessary to prevent a fall.
"""

from collections.abc import Callable

import numpy as np

from windup.control.footprints.footprints import Footprint
from windup.control.footprints.torque_directed import TorqueDirected
from windup.control.kinematics.momenta import capture_point
from windup.control.kinematics.places import onto, seen_from
from windup.control.kinematics.support import SupportRegion
from windup.control.stepping.comfort import ASKEW
from windup.hal.joints import Array


class ComfortWalk(TorqueDirected):
    """Walks one footprint, unless the legs are too short to shift the CoM over the stance foot.

    Attributes:
        given_up: The step was given up for that reason.
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
    """Computes the step that brings the feet back to their places in the stance.

    Args:
        walk: Returns the controller that walks one footprint.
        most: Maximum distance of a foot from its nominal place without a comfort step, m.
    """

    def __init__(self, walk: Walk, most: float) -> None:
        self.walk, self._most = walk, most

    def reset(self, places: Array) -> None:
        """Set the nominal places (2, 3), x m, y m, yaw rad, of the feet in the stance."""
        self._homes = [seen_from(places[1 - foot], places[foot]) for foot in (0, 1)]

    def needed(self, places: Array, allows: Allows) -> Footprint | None:
        """Return the footprint of the comfort step, or None if none is needed or allowed.

        Args:
            places: (2, 3) present places of the feet.
            allows: Returns whether a step is allowed, from the foot's index, heading, rad, start
                and target, (2,) m; see `KeepOutRegions.allows`.
        """
        targets = [onto(places[1 - foot], self._homes[foot]) for foot in (0, 1)]
        aside = [target - place for target, place in zip(targets, places, strict=True)]
        # Both errors are about equal; the foot that steps forward leaves the other in front.
        yaw = places[:, 2].mean()
        foot = int(np.argmax([way[:2] @ [np.cos(yaw), np.sin(yaw)] for way in aside]))
        turned = seen_from(targets[foot], places[foot])[2]
        if np.hypot(*aside[foot][:2]) <= self._most and abs(turned) <= ASKEW:
            return None
        if not allows(foot, float(targets[foot][2]), places[foot, :2], targets[foot][:2]):
            return None
        return Footprint(foot, self._homes[foot])
