"""Feeling slippery ground: the sole that bears the body slides away under it.

The rollouts believe in the friction of their model. A sole also rolls, and at some speeds lands
sliding with one foot of the two; so only a slide in two steps running counts.
"""

from collections import deque
from dataclasses import dataclass, field

import numpy as np

from windup.control.pose_graph.gait_file import Slip
from windup.hal.joints import Array

RUNNING = 2  # steps


@dataclass
class SlipControl:
    """Calls for a style from the moment that the stance foot is felt to slide.

    Attributes:
        law: States, style and the least slide that counts.
        states: Indices of the states in which the stance foot bears the body.
        felt: True since it has slid.
    """

    law: Slip
    states: frozenset[int]
    felt: bool = field(default=False, init=False)
    _began: Array | None = field(default=None, init=False)
    _ways: deque[float] = field(default_factory=lambda: deque(maxlen=RUNNING), init=False)

    def reset(self) -> None:
        """Begin on ground that holds."""
        self.felt, self._began = False, None
        self._ways.clear()

    def entered(self, state: int, foot: Array) -> None:
        """Measure the state that has ended; `foot` (3,) m is where the stance foot is now."""
        if self._began is not None:
            self._ways.append(float(np.linalg.norm((foot - self._began)[:2])))
            slid = len(self._ways) == RUNNING and min(self._ways) > self.law.least
            self.felt = self.felt or slid
        self._began = foot.copy() if state in self.states else None

    def styles(self) -> dict[str, float]:
        """Return the amounts of styles that it calls for."""
        return {self.law.style: 1.0} if self.felt else {}
