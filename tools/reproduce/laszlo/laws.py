"""Laws of chapter 5 that act on a walk from outside: speed by Eq. 5.1, and a constant turn."""

from dataclasses import dataclass, field

import numpy as np

from windup.control.limit_cycle.balancer import Balancer
from windup.control.steering.course import Course
from windup.control.steering.speed import SpeedControl
from windup.hal.joints import Array


@dataclass
class SpeedLaw(SpeedControl):
    """Eq. 5.1: the targets of each step are a bias plus a limited gain times the speed's error.

    As in Table 5.2, speed is the way of the pelvis over the last step, m a step, forward and to
    the left. Our lateral components are positive toward the foot that has just swung, so the
    lateral correction changes sign with the stance foot and the bias does not.

    Attributes:
        bias: Names of the forward and lateral variable, and the bias of each.
        changes: From which step on the forward bias is another one.
        gain: k_p, forward and lateral.
        limit: Largest correction, forward and lateral.
        desired: v_d, m a step, forward and lateral.
    """

    bias: dict[str, float] = field(default_factory=dict)
    changes: list[tuple[int, float]] = field(default_factory=list)
    gain: tuple[float, float] = (1.5, 0.5)
    limit: tuple[float, float] = (0.15, 0.05)
    desired: tuple[float, float] = (0.4, 0.0)
    walker: Balancer | None = None

    def targets(self) -> dict[str, float]:
        """Return the targets of the step that begins now."""
        assert self.walker is not None
        change = np.array(self.gain) * (np.array(self.desired) - self._way())
        forward, left = np.clip(change, -np.array(self.limit), self.limit)
        side = -1.0 if self._swings_right() else 1.0
        names = list(self.bias)
        return {
            names[0]: self._forward() + float(forward),
            names[1]: self.bias[names[1]] + side * float(left),
        }

    def _forward(self) -> float:
        assert self.walker is not None
        value = next(iter(self.bias.values()))
        for step, later in self.changes:
            value = later if self.walker.steps >= step else value
        return value

    def _way(self) -> Array:
        """Return the way of the last step (2,) m along and across its heading; at first none."""
        assert self.walker is not None
        records = self.walker.records
        if len(records) < 2:
            return np.array(self.desired)
        x, y = (records[-1].position - records[-2].position)[:2]
        c, s = np.cos(records[-1].heading), np.sin(records[-1].heading)
        return np.array([c * x + s * y, c * y - s * x])

    def _swings_right(self) -> bool:
        """Tell whether the right foot swings; the human begins on its right foot."""
        assert self.walker is not None
        return self.walker.steps % 2 == 1


@dataclass
class ConstantTurn(Course):
    """A turning perturbation scaled the same at every step (section 5.3).

    Attributes:
        degrees: Its scaling; positive turns left.
    """

    degrees: float = 0.0

    def scale(self, heading: float) -> float:
        """Return the scaling of the coming step."""
        return self.degrees
