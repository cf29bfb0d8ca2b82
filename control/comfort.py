"""A comfort step: a robot that stands still puts one foot back where its stance has it."""

from math import cos, pi

import numpy as np

from control.footing import Footing
from control.rotation import turn
from control.swing import swing_foot
from hal.joints import Array

SHIFT = 0.5
"""Time to bring the centre of mass over one foot, and back, s."""
SWING = 0.4
"""Time for the foot in the air, s."""


class ComfortStep:
    """Shifts the weight to one foot, brings the other to its place beside it, and comes back.

    Kenwright 2012, section IV: after a disturbance people return to a relaxed stance by steps
    that no fall forces on them.

    Args:
        footing: The feet, of a robot that stands still.
        now: s.
        lift: How high the foot is lifted, m.

    Attributes:
        foot: The foot that steps: the one that is behind or too far out.
        astray: How far it stands from its place beside the other one, m.
        target: (3,) that place, m.
    """

    def __init__(self, footing: Footing, now: float, lift: float) -> None:
        self._footing, self._began, self._lift = footing, now, lift
        aside = [self._home(foot) - footing.places[foot] for foot in (0, 1)]
        # Both miss by about as much; the one that has to go forward leaves the other in front.
        forward = turn(footing.yaw)[:2, 0]
        self.foot = int(np.argmax([way @ forward for way in aside]))
        self.astray = float(np.linalg.norm(aside[self.foot]))
        self._start = np.append(footing.places[self.foot], 0.0)
        self._centre = footing.base.position[:2].copy()
        stance = footing.places[1 - self.foot]
        com = footing.momenta.com[:2] - footing.base.position[:2]
        self._over = stance - com
        self.target = np.append(self._home(self.foot), 0.0)

    def done(self, now: float) -> bool:
        """Return whether the step is over."""
        return now - self._began >= 2.0 * SHIFT + SWING

    def pose(self, goals: Array, now: float) -> None:
        """Set the legs' joints in `goals` (n,) rad."""
        gone, footing = now - self._began, self._footing
        stance = 1 - self.foot
        if gone < SHIFT:
            base = footing.upright(_between(self._centre, self._over, gone / SHIFT))
            for foot in (0, 1):
                footing.stand(goals, foot, base)
        elif gone < SHIFT + SWING:
            base = footing.upright(self._over)
            part = (gone - SHIFT) / SWING
            at = swing_foot(self._start, self.target, part, self._lift)
            footing.put(goals, self.foot, at, base)
            footing.stand(goals, stance, base)
        else:
            part = (gone - SHIFT - SWING) / SHIFT
            base = footing.upright(_between(self._over, footing.home(), part))
            for foot in (0, 1):
                footing.stand(goals, foot, base)

    def _home(self, foot: int) -> Array:
        """Return where (2,) m a foot is in the stance, beside the other one as that stands."""
        footing = self._footing
        way = footing.homes[foot][:2] - footing.homes[1 - foot][:2]
        return footing.places[1 - foot] + turn(footing.yaw)[:2, :2] @ way


def _between(start: Array, end: Array, part: float) -> Array:
    """Return a point on the way, with no speed at its ends."""
    return start + 0.5 * (1.0 - cos(pi * min(part, 1.0))) * (end - start)
