"""Noticing at any moment of a step that a push has thrown a walk off its way."""

from dataclasses import dataclass, field

import numpy as np

from windup.hal.joints import Array

LEARN = 3
"""Steps alike that have to be seen before one can be judged."""
SHARE, DRIFT = 0.3, 0.004
"""How far what is usual follows what is seen: this share of it, and m at most."""


@dataclass
class CapturePointDeviation:
    """Compares a point with where it was at the same moment of the last steps alike.

    A moment is a state of the pose graph and the tick in it. What is usual follows slowly, so that
    a change of speed is no throw, and one push hardly makes the next look usual.
    """

    _usual: dict[int, list[Array]] = field(default_factory=dict, init=False)
    _seen: dict[int, int] = field(default_factory=dict, init=False)

    def reset(self) -> None:
        """Forget what is usual."""
        self._usual.clear()
        self._seen.clear()

    def detect(self, state: int, tick: int, point: Array) -> Array:
        """Return how far (2,) m a point is from where it usually is; zero where nobody knows.

        Args:
            state: Index of the state.
            tick: Ticks since it was entered, from 0 without a gap.
            point: (2,) m, in a frame that steps alike have in common.
        """
        usual = self._usual.setdefault(state, [])
        if tick == 0:
            self._seen[state] = self._seen.get(state, 0) + 1
        if tick >= len(usual):  # it lasts longer than ever
            usual.append(point.copy())
            return np.zeros(2)
        away = point - usual[tick]
        usual[tick] = usual[tick] + np.clip(SHARE * away, -DRIFT, DRIFT)
        return away if self._seen[state] > LEARN else np.zeros(2)
