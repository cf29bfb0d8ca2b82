"""Detection of a push during a walk, at any tick, by the deviation of the capture point."""

from dataclasses import dataclass, field

import numpy as np

from windup.hal.joints import Array

LEARN = 3
"""Number of equal steps that are needed before a deviation is reported."""
SHARE, DRIFT = 0.3, 0.004
"""Update of the reference per step: share of the deviation, and its maximum, m."""


@dataclass
class CapturePointDeviation:
    """Compares a point with its reference at the same moment of the last equal steps.

    A moment is a state of the pose graph and the tick in it. The reference follows the point
    slowly, so that a change of speed is not a push, and a push hardly changes the reference.
    """

    _usual: dict[int, list[Array]] = field(default_factory=dict, init=False)
    _seen: dict[int, int] = field(default_factory=dict, init=False)

    def reset(self) -> None:
        """Discard all references."""
        self._usual.clear()
        self._seen.clear()

    def detect(self, state: int, tick: int, point: Array) -> Array:
        """Return the deviation (2,) m of a point from its reference; 0 as long as that is unknown.

        Args:
            state: Index of the state.
            tick: Ticks since the state was entered, counted from 0 without a gap.
            point: (2,) m, in a frame relative to the step, such as the stance foot's.
        """
        usual = self._usual.setdefault(state, [])
        if tick == 0:
            self._seen[state] = self._seen.get(state, 0) + 1
        if tick >= len(usual):  # the state has never lasted so long
            usual.append(point.copy())
            return np.zeros(2)
        away = point - usual[tick]
        usual[tick] = usual[tick] + np.clip(SHARE * away, -DRIFT, DRIFT)
        return away if self._seen[state] > LEARN else np.zeros(2)
