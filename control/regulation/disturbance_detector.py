"""Noticing in mid-step that a step does not go as the last ones did."""

from dataclasses import dataclass, field

import numpy as np

from windup.hal.joints import Array


@dataclass
class DisturbanceDetector:
    """Compares the velocity of the centre of mass with that of the same state two steps ago.

    Attributes:
        threshold: Difference that counts, m/s.
    """

    threshold: float
    _usual: dict[int, Array] = field(default_factory=dict, init=False)
    _state: int = field(default=-1, init=False)

    def reset(self) -> None:
        """Forget what is usual."""
        self._usual.clear()
        self._state = -1

    def entered(self, state: int) -> bool:
        """Return True in the first tick of a state."""
        new, self._state = state != self._state, state
        return new

    def detect(self, state: int, velocity: Array, heading: float) -> bool:
        """Return True if `velocity` (3,) m/s at the start of a state is unusual there."""
        c, s = np.cos(heading), np.sin(heading)
        now = np.array([c * velocity[0] + s * velocity[1], c * velocity[1] - s * velocity[0]])
        usual = self._usual.get(state)
        self._usual[state] = now
        return usual is not None and float(np.linalg.norm(now - usual)) > self.threshold
