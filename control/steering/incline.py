"""Slope compensation: the soles are tilted by the mean error of a regulation variable.

The rollouts assume level ground. An uphill slope tips the body back at every step, a downhill one
forward, by more than balance corrects; the remaining error shows which way the ground slopes.
"""

from dataclasses import dataclass, field

import numpy as np

from windup.control.pose_graph.gait_file import Incline
from windup.control.regulation.step_record import StepRecord


@dataclass
class InclineControl:
    """Scales a perturbation by the low-pass filtered error of one regulation variable.

    Attributes:
        law: The `incline` table of the gait: perturbation, gain, rate and limit.
        column: Index of the variable in the step records.
        present: Present scaling.
    """

    law: Incline
    column: int
    present: float = field(default=0.0, init=False)

    def reset(self) -> None:
        """Start over, with level ground assumed."""
        self.present = 0.0

    def measured(self, record: StepRecord) -> None:
        """Update the scaling from the step that has just ended."""
        law = self.law
        missed = float(record.target[self.column] - record.regulation[self.column])
        self.present += law.rate * (law.gain * missed - self.present)
        self.present = float(np.clip(self.present, -law.limit, law.limit))
