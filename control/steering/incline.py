"""Feeling a slope: soles tilt with the ground when the body leans other than it was planned to.

The rollouts believe in level ground. Uphill the ground tips the body back and downhill forward,
step after step, by more than balance takes away; what is left says which way the ground slopes.
"""

from dataclasses import dataclass, field

import numpy as np

from windup.control.pose_graph.gait_file import Incline
from windup.control.regulation.step_record import StepRecord


@dataclass
class InclineControl:
    """Scales a perturbation by the mean miss of one regulation variable.

    Attributes:
        law: Perturbation, gain and limit.
        column: Index of the variable in the records.
        present: Present scaling.
    """

    law: Incline
    column: int
    present: float = field(default=0.0, init=False)

    def reset(self) -> None:
        """Begin on level ground."""
        self.present = 0.0

    def measured(self, record: StepRecord) -> None:
        """Learn from the step that has just ended."""
        law = self.law
        missed = float(record.target[self.column] - record.regulation[self.column])
        self.present += law.rate * (law.gain * missed - self.present)
        self.present = float(np.clip(self.present, -law.limit, law.limit))
