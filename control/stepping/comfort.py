"""A comfort step: a robot that stands still puts one foot back to its place in the stance."""

from math import cos, pi
from typing import Literal

import numpy as np

from windup.control.execution.footing import Footing
from windup.control.execution.swing import swing_foot
from windup.control.kinematics.momenta import capture_point
from windup.control.kinematics.rotation import heading_between, turn, way_round
from windup.control.stepping.stepping_file import Stepping
from windup.hal.joints import Array

SHIFT = 0.5
"""Time to shift the centre of mass over one foot, and time to shift it back, s."""
WAIT = 0.3
"""Additional time after `SHIFT` before the step is given up, s."""
SWING = 0.4
"""Duration of the swing, s."""
INSIDE = 0.02
"""Minimum distance of CoM and capture point inside a sole for standing on that foot alone, m."""
STILL = 0.05
"""Maximum speed of the centre of mass of a robot that stands still, m/s."""
ASKEW = 0.15
"""Maximum yaw between the feet of a relaxed stance, rad."""

Phase = Literal["shift", "swing", "back"]


class ComfortStep:
    """Shifts the weight to one foot, puts the other back beside it, and shifts the weight back.

    Kenwright 2012, section IV: after a disturbance people return to a relaxed stance, in position
    and direction, by steps that are not necessary to prevent a fall.

    Args:
        footing: The feet of a robot that stands still.
        now: Present time, s.
        stepping: Stepping parameters of the robot.

    Attributes:
        foot: Index of the foot that steps: the one that has to move further forward.
        target: (3,) its nominal place beside the other one, m.
        needed: It is too far from that place, or turned too far relative to the other foot.
        given_up: The CoM did not come over the stance foot in time.
    """

    def __init__(self, footing: Footing, now: float, stepping: Stepping) -> None:
        self._footing, self._began, self._stepping = footing, now, stepping
        self._planted = planted = footing.planted()
        aside = [self._home(foot) - footing.places[foot] for foot in (0, 1)]
        # Both errors are about equal; the foot that steps forward leaves the other in front.
        forward = turn(planted.front)[:2, 0]
        self.foot = int(np.argmax([way @ forward for way in aside]))
        self.target = np.append(self._home(self.foot), 0.0)
        far = float(np.linalg.norm(aside[self.foot]))
        self.needed = far > stepping.comfort or abs(way_round(*planted.yaws)) > ASKEW
        self.given_up = False
        self._phase: Phase = "shift"
        self._place = self._from = footing.base.position[:2].copy()
        com = footing.momenta.com[:2] - footing.base.position[:2]
        self._over = footing.places[1 - self.foot] - com
        self._before, self._after = footing.yaw, float(planted.yaws[1 - self.foot])

    def done(self, now: float) -> bool:
        """Return whether the step is over or given up, with the weight shifted back."""
        return self._phase == "back" and now - self._began >= SHIFT

    def pose(self, goals: Array, now: float) -> None:
        """Set the goals of the legs' joints in `goals` (n,), rad."""
        self._go_on(now)
        if self._phase == "swing":
            self._swing(goals, now - self._began)
            return
        footing, part = self._footing, _eased((now - self._began) / SHIFT)
        shifts = self._phase == "shift"
        to = self._over if shifts else footing.home(self._planted)
        self._place = self._from + part * (to - self._from)
        base = footing.upright(self._place, self._before if shifts else self._planted.front)
        for foot in (0, 1):
            footing.keep(goals, foot, self._planted, base)

    def _go_on(self, now: float) -> None:
        """Enter the next phase if it is due: swing once the other foot can bear the robot."""
        gone, footing, foot = now - self._began, self._footing, self.foot
        if self._phase == "shift":
            other, momenta = footing.support((1 - foot,)), footing.momenta
            if min(other.margin(capture_point(momenta)), other.margin(momenta.com)) > INSIDE:
                self._begin("swing", now)
            elif gone > SHIFT + WAIT:
                self.given_up = True
                self._begin("back", now)
        elif self._phase == "swing" and gone > SWING:
            # Start from the measured base: it may not have come all the way over the other foot.
            self._place = footing.base.position[:2].copy()
            self._planted = self._planted.step(foot, self.target, self._after)
            self._begin("back", now)

    def _swing(self, goals: Array, gone: float) -> None:
        """Set the goals of the swing: the foot moves to its target, the base over the other."""
        part = _eased(gone / SWING)
        place = self._from + part * (self._over - self._from)
        base = self._footing.upright(place, heading_between(self._before, self._after, part))
        start = self._planted.places[self.foot]
        heading = heading_between(self._planted.yaws[self.foot], self._after, part)
        at = swing_foot(start, self.target, gone / SWING, self._stepping.lift)
        self._footing.put(goals, self.foot, at, heading, base)
        self._footing.keep(goals, 1 - self.foot, self._planted, base)

    def _begin(self, phase: Phase, now: float) -> None:
        self._phase, self._began, self._from = phase, now, self._place

    def _home(self, foot: int) -> Array:
        """Return the nominal place (2,) m of a foot, relative to where the other one stands."""
        homes, other = self._footing.homes, 1 - foot
        way = turn(self._planted.yaws[other])[:2, :2] @ (homes[foot] - homes[other])[:2]
        return self._footing.places[other] + way


def _eased(part: float) -> float:
    """Return the fraction of a path that is done at the time fraction `part`, eased in and out."""
    return 0.5 * (1.0 - cos(pi * min(part, 1.0)))
