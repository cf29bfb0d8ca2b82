"""Detection of slippery ground, by the horizontal motion of the stance foot.

The rollouts assume the friction of their model. A sole also rolls, and at some speeds one of the
two feet slides at touchdown; so only slides in two consecutive steps count.
"""

from collections import deque
from dataclasses import dataclass, field

import numpy as np

from windup.control.pose_graph.gait_file import Slip
from windup.hal.joints import Array

RUNNING = 2  # number of consecutive steps with a slide


@dataclass
class SlipControl:
    """Requests a style once the stance foot has been detected to slide.

    Attributes:
        law: The `slip` table of the gait: states, style and minimum slide.
        states: Indices of the states in which the stance foot bears the body.
        felt: True once a slide has been detected.
    """

    law: Slip
    states: frozenset[int]
    felt: bool = field(default=False, init=False)
    _began: Array | None = field(default=None, init=False)
    _ways: deque[float] = field(default_factory=lambda: deque(maxlen=RUNNING), init=False)

    def reset(self) -> None:
        """Start over, with no slide detected."""
        self.felt, self._began = False, None
        self._ways.clear()

    def entered(self, state: int, foot: Array) -> None:
        """Enter `state` and check the slide in the last one; `foot` (3,) m is the stance foot."""
        if self._began is not None:
            self._ways.append(float(np.linalg.norm((foot - self._began)[:2])))
            slid = len(self._ways) == RUNNING and min(self._ways) > self.law.least
            self.felt = self.felt or slid
        self._began = foot.copy() if state in self.states else None

    def styles(self) -> dict[str, float]:
        """Return the requested styles with their amounts."""
        return {self.law.style: 1.0} if self.felt else {}
