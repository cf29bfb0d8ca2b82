"""A comfort step: a robot that stands still puts one foot back where its stance has it."""

from math import cos, pi
from typing import Literal

import numpy as np

from windup.control.footprints.swing import swing_foot
from windup.control.kinematics.momenta import capture_point
from windup.control.kinematics.rotation import heading_between, turn, way_round
from windup.control.stepping.footing import Footing
from windup.control.stepping.stepping_file import Stepping
from windup.hal.joints import Array

SHIFT = 0.5
"""Time to bring the centre of mass over one foot, and back, s."""
WAIT = 0.3
"""How much longer than planned it may be on its way, s."""
SWING = 0.4
"""Time for the foot in the air, s."""
INSIDE = 0.02
"""How far inside a sole the centre of mass has to be for that foot to bear the robot alone, m."""
STILL = 0.05
"""The centre of mass of a robot that stands still is slower than this, m/s."""
ASKEW = 0.15
"""The feet of a relaxed stance are turned less than this from each other, rad."""

Phase = Literal["shift", "swing", "back"]


class ComfortStep:
    """Shifts the weight to one foot, brings the other to its place beside it, and comes back.

    Kenwright 2012, section IV: after a disturbance people return to a relaxed stance by steps
    that no fall forces on them, in position and direction.

    Args:
        footing: The feet, of a robot that stands still.
        now: s.
        stepping: How this robot steps.

    Attributes:
        foot: The foot that steps: the one that is behind or too far out.
        target: (3,) its place beside the other one, m.
        needed: Does it stand farther from there, or turned farther from the other, than it may?
        given_up: The centre of mass did not come over the other foot.
    """

    def __init__(self, footing: Footing, now: float, stepping: Stepping) -> None:
        self._footing, self._began, self._stepping = footing, now, stepping
        self._planted = planted = footing.planted()
        aside = [self._home(foot) - footing.places[foot] for foot in (0, 1)]
        # Both miss by about as much; the one that has to go forward leaves the other in front.
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
        """Return whether the step is over, or given up."""
        return self._phase == "back" and now - self._began >= SHIFT

    def pose(self, goals: Array, now: float) -> None:
        """Set the legs' joints in `goals` (n,) rad."""
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
        """Lift the foot as soon as the other one can bear the robot; put it down in time."""
        gone, footing, foot = now - self._began, self._footing, self.foot
        if self._phase == "shift":
            other, momenta = footing.support((1 - foot,)), footing.momenta
            if min(other.margin(capture_point(momenta)), other.margin(momenta.com)) > INSIDE:
                self._begin("swing", now)
            elif gone > SHIFT + WAIT:
                self.given_up = True
                self._begin("back", now)
        elif self._phase == "swing" and gone > SWING:
            # From where it is: it may not have come all the way over the other foot.
            self._place = footing.base.position[:2].copy()
            self._planted = self._planted.step(foot, self.target, self._after)
            self._begin("back", now)

    def _swing(self, goals: Array, gone: float) -> None:
        """Bring the foot to its place while the base comes over the other one."""
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
        """Return where (2,) m a foot is in the stance, beside the other one as that stands."""
        homes, other = self._footing.homes, 1 - foot
        way = turn(self._planted.yaws[other])[:2, :2] @ (homes[foot] - homes[other])[:2]
        return self._footing.places[other] + way


def _eased(part: float) -> float:
    """Return how much of a way is done, with no speed at its ends."""
    return 0.5 * (1.0 - cos(pi * min(part, 1.0)))
