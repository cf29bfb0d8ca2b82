"""Detection of disturbances within a step, by comparison with an earlier step."""

from dataclasses import dataclass, field

import numpy as np

from windup.hal.joints import Array


@dataclass
class DisturbanceDetector:
    """Compares the velocity of the centre of mass with that at the last entry into the same state.

    Attributes:
        threshold: Minimum difference that counts as a disturbance, m/s.
    """

    threshold: float
    _usual: dict[int, Array] = field(default_factory=dict, init=False)
    _state: int = field(default=-1, init=False)

    def reset(self) -> None:
        """Discard all stored velocities."""
        self._usual.clear()
        self._state = -1

    def entered(self, state: int) -> bool:
        """Return True at the first tick of a state; call it at every tick."""
        new, self._state = state != self._state, state
        return new

    def detect(self, state: int, velocity: Array, heading: float) -> bool:
        """Return True if `velocity` (3,) m/s at the entry into a state differs too much."""
        c, s = np.cos(heading), np.sin(heading)
        now = np.array([c * velocity[0] + s * velocity[1], c * velocity[1] - s * velocity[0]])
        usual = self._usual.get(state)
        self._usual[state] = now
        return usual is not None and float(np.linalg.norm(now - usual)) > self.threshold
