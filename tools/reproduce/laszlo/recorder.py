"""What a walk leaves behind: a row for each step, and a trace of the motion between them."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from windup.control.kinematics.rotation import heading
from windup.control.limit_cycle.balancer import Balancer
from windup.hal.observation import Observation

LISTS = ("q", "target", "k")
TRACE = 0.02  # s between samples
# Columns of a trace; vectors are projected on the ground, forward and to the left of the hips
# (Fig. 3.13).
NAMES: tuple[str, ...] = ("time", "step", "x", "y", "yaw", "z", "up.f", "up.l")
NAMES += ("left_com.f", "left_com.l", "right_com.f", "right_com.l")


@dataclass
class Recorder:
    """Watches a walk.

    Attributes:
        walker: The walk's controller.
        traced: Keep the motion between the ends of steps too.
        lengths: Step length of each step, m.
        trace: Samples; see `NAMES`.
    """

    walker: Balancer
    traced: bool
    lengths: list[float] = field(default_factory=list)
    trace: list[list[float]] = field(default_factory=list)
    _due: float = 0.0

    def add(self, observation: Observation) -> None:
        """Take an observation."""
        if self.walker.steps > len(self.lengths):
            self.lengths.append(self._step_length(observation))
        if self.traced and observation.time >= self._due:
            self._due = observation.time + TRACE - 1e-9
            self.trace.append(self._sample(observation))

    def _step_length(self, observation: Observation) -> float:
        """Return the way between the feet along the heading at the end of a step, m."""
        at = self.walker.state.update(observation).outcomes
        angle = float(heading(at.base_orientation)[0])
        apart = at.feet[0, 0] - at.feet[0, 1]
        return abs(float(np.cos(angle) * apart[0] + np.sin(angle) * apart[1]))

    def _sample(self, observation: Observation) -> list[float]:
        at = self.walker.state.update(observation).outcomes
        angle = float(heading(at.base_orientation)[0])
        c, s = np.cos(angle), np.sin(angle)
        x, y, z = at.base_position[0]
        row = [observation.time, self.walker.steps, x, y, angle, z]
        for vector in (at.torso[0], *(at.com[0] - at.feet[0])):
            unit = vector / np.linalg.norm(vector)
            row += [c * unit[0] + s * unit[1], c * unit[1] - s * unit[0]]
        return [round(float(value), 4) for value in row]

    def result(self) -> dict[str, Any]:
        """Return everything as plain data."""
        records = self.walker.records
        lengths = self.lengths + [None] * (len(records) - len(self.lengths))
        return {
            "variables": [variable.name for variable in self.walker.regulation],
            "records": [
                {
                    "time": record.time,
                    "duration": record.duration,
                    "x": record.position[0],
                    "y": record.position[1],
                    "heading": record.heading,
                    "speed": record.speed,
                    "length": length,
                    "q": record.regulation,
                    "target": record.target,
                    "k": [record.scale[self.walker.gait.index(n)] for n in self._perturbations()],
                }
                for record, length in zip(records, lengths, strict=True)
            ],
            "trace": self.trace,
        }

    def _perturbations(self) -> list[str]:
        return self.walker.perturbations


def column(result: dict[str, Any], name: str) -> Any:
    """Return one column of a trace as an array (samples,)."""
    rows = np.array(result["trace"]).reshape(-1, len(NAMES))
    return rows[:, NAMES.index(name)]


def records(result: dict[str, Any], name: str) -> Any:
    """Return one number of every step as an array (steps,), or (steps, r) for lists."""
    rows = np.array([row[name] for row in result["records"]], dtype=float)
    return rows if len(rows) or name not in LISTS else np.zeros((0, 2))
