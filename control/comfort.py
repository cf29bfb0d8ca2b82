"""A comfort step: a robot that stands still puts one foot back where its stance has it."""

from math import cos, pi
from typing import Literal

import numpy as np

from control.footing import Footing
from control.limb_ik import Pose
from control.momenta import capture_point
from control.rotation import heading_between, turn, way_round
from control.stepping_file import Stepping
from control.swing import gaussian_progress, swing_foot
from hal.joints import Array

SHIFT = 0.5
"""Time to bring the centre of mass over one foot, and back, s."""
WAIT = 0.3
"""How much longer than planned it may be on its way, s."""
SWING = 0.4
"""Time for the foot in the air, s."""
WIDE, QUICK = 0.12, 0.28
"""A foot that has to go farther, m, goes in that time, s: nothing balances over one leg then."""
INSIDE = 0.02
"""How far inside a sole the capture point has to be for that foot to bear the robot alone, m."""
STRETCHED, BARELY = 0.005, 0.01
"""A leg that misses its place by so much is at its end, m; then so far inside has to do, m."""
ASKEW = 0.15
"""The feet of a relaxed stance are turned less than this from each other, rad."""

Phase = Literal["shift", "swing", "back"]


class ComfortStep:
    """Shifts the weight to one foot, brings the other to its place beside it, and comes back.

    Kenwright 2012, section IV: after a disturbance people return to a relaxed stance by steps
    that no fall forces on them, in position and direction. Feet that stand far apart do not let
    the base come all the way over one of them: it has to run there, and the foot behind leaves
    the ground on the way, as soon as the capture point is inside the other sole.

    Args:
        footing: The feet, of a robot that stands still.
        now: s.
        stepping: How this robot steps.

    Attributes:
        foot: The foot that steps: the one that is behind or too far out.
        target: (3,) its place beside the other one, m.
        needed: Does it stand farther from there, or turned farther from the other, than it may?
        given_up: The legs are too short to come from one foot to the other as they stand.
    """

    def __init__(self, footing: Footing, now: float, stepping: Stepping) -> None:
        self._footing, self._began, self._stepping = footing, now, stepping
        planted = footing.planted()
        self._yaws, self._places = planted.yaws, planted.places
        aside = [self._home(foot) - footing.places[foot] for foot in (0, 1)]
        # Both miss by about as much; the one that has to go forward leaves the other in front.
        forward = turn(footing.front)[:2, 0]
        self.foot = int(np.argmax([way @ forward for way in aside]))
        self.target = np.append(self._home(self.foot), 0.0)
        far = float(np.linalg.norm(aside[self.foot]))
        self.needed = far > stepping.comfort or abs(way_round(*self._yaws)) > ASKEW
        self.given_up = False
        self._quick = far > WIDE
        self._phase: Phase = "shift"
        self._place = self._from = footing.base.position[:2].copy()
        com = footing.momenta.com[:2] - footing.base.position[:2]
        self._over = footing.places[1 - self.foot] - com
        self._before, self._after = footing.yaw, self._yaws[1 - self.foot]

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
        to = self._over if shifts else footing.home()
        self._place = self._from + part * (to - self._from)
        base = footing.upright(self._place, self._before if shifts else footing.front)
        for foot in (0, 1):
            self._keep(goals, foot, base)

    def _go_on(self, now: float) -> None:
        """Lift the foot as soon as the other one can bear the robot; put it down in time."""
        gone, footing, foot = now - self._began, self._footing, self.foot
        if self._phase == "shift":
            other, momenta = footing.support((1 - foot,)), footing.momenta
            inside = other.margin(capture_point(momenta))
            if not self._quick:
                # It stays on that foot for a while: the centre of mass itself has to be over it.
                inside = min(inside, other.margin(momenta.com))
            stretched = footing.missed(foot) > STRETCHED
            if inside > (BARELY if stretched else INSIDE):
                self._places[foot, :2] = footing.places[foot]
                self._begin("swing", now)
            elif stretched or gone > SHIFT + WAIT:
                self.given_up = True
                self._begin("back", now)
        elif self._phase == "swing" and (gone > self._time or self._touches(gone)):
            # From where it is: it never came all the way over the other foot.
            self._place = footing.base.position[:2].copy()
            self._places[foot], self._yaws[foot] = self.target, self._after
            self._begin("back", now)

    def _swing(self, goals: Array, gone: float) -> None:
        """Bring the foot to its place while the base comes over the other one."""
        stepping, start = self._stepping, self._places[self.foot]
        part = _eased(gone / self._time)
        place = self._over if self._quick else self._from + part * (self._over - self._from)
        base = self._footing.upright(place, heading_between(self._before, self._after, part))
        heading = heading_between(self._yaws[self.foot], self._after, part)
        if self._quick:
            # As a step that prevents a fall: up at once, and seen from where the base will be.
            way = gaussian_progress((gone + stepping.lead) / self._time)
            at = start + way * (self.target - start)
            at[2] = stepping.lift if gone < stepping.up * self._time else 0.0
            seen = self._footing.ahead(stepping.lead)
        else:
            at, seen = swing_foot(start, self.target, gone / self._time, stepping.lift), base
        self._footing.put(goals, self.foot, at, heading, seen)
        self._keep(goals, 1 - self.foot, base)

    @property
    def _time(self) -> float:
        """For the foot in the air, s."""
        return QUICK if self._quick else SWING

    def _touches(self, gone: float) -> bool:
        """Return whether a quick step has come down early."""
        return self._quick and gone > 0.5 * QUICK and self._footing.down[self.foot]

    def _begin(self, phase: Phase, now: float) -> None:
        self._phase, self._began, self._from = phase, now, self._place

    def _keep(self, goals: Array, foot: int, base: Pose) -> None:
        """Keep a foot where it was put: one that slips is not followed."""
        self._footing.put(goals, foot, self._places[foot], self._yaws[foot], base)

    def _home(self, foot: int) -> Array:
        """Return where (2,) m a foot is in the stance, beside the other one as that stands."""
        homes, other = self._footing.homes, 1 - foot
        way = turn(self._yaws[other])[:2, :2] @ (homes[foot] - homes[other])[:2]
        return self._footing.places[other] + way


def _eased(part: float) -> float:
    """Return how much of a way is done, with no speed at its ends."""
    return 0.5 * (1.0 - cos(pi * min(part, 1.0)))
