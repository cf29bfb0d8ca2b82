"""Holding a course: turn a little each step, in proportion to the error."""

from dataclasses import dataclass

import numpy as np

from control.gait_file import Heading
from hal.joints import Array


@dataclass
class Course:
    """Scales a turning perturbation by the heading error.

    Attributes:
        law: Perturbation, gain and limit.
        direction: Wanted heading, rad.
    """

    law: Heading
    direction: float = 0.0

    @property
    def perturbation(self) -> str:
        """Name of the turning perturbation."""
        return self.law.perturbation

    def scale(self, heading: float, position: Array) -> float:
        """Return the scaling for a base that faces `heading` rad at `position` (3,) m."""
        error = np.degrees((self.direction - heading + np.pi) % (2.0 * np.pi) - np.pi)
        return float(np.clip(self.law.gain * error, -self.law.limit, self.law.limit))
