"""Feeling how the ground slopes, from where the feet have stood."""

from collections import deque
from dataclasses import dataclass, field

import numpy as np

from hal.controller import LEVEL, Plane
from hal.joints import Array

NOISE = 0.01
"""How far a sole's centre is from a plane on ground that is flat by and large, m."""
PRIOR = 0.05
"""Slope that ground usually has, so that two feet side by side prove little."""
SLIGHT = 0.012
"""A slope below this is level: a foot that is tilted or sinks in shows as much."""


@dataclass
class Footfalls:
    """Fits a plane to the last places where a foot has stood.

    Attributes:
        count: How many places count.
    """

    count: int
    _places: deque[Array] = field(init=False)
    _lowest: Array | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget all places."""
        self._places = deque(maxlen=self.count)
        self._lowest = None

    def see(self, sole: Array) -> None:
        """Take the centre (3,) m of the stance foot's sole; a step counts where it was lowest."""
        if self._lowest is None or sole[2] < self._lowest[2]:
            self._lowest = sole.copy()

    def end_step(self) -> None:
        """Count the place of the step that has ended."""
        if self._lowest is not None:
            self._places.append(self._lowest)
        self._lowest = None

    def plane(self) -> Plane:
        """Return the ground: its height at the origin, m, and how it rises along x and y."""
        if not self._places:
            return LEVEL
        last, (a, b) = self._places[-1], self._slope()
        return float(last[2] - last[0] * a - last[1] * b), float(a), float(b)

    def _slope(self) -> Array:
        """Return the gradient (2,) of the ground."""
        away = np.array(self._places) - np.mean(self._places, axis=0)
        flat, height = away[:, :2], away[:, 2]
        normal = flat.T @ flat + (NOISE / PRIOR) ** 2 * np.eye(2)
        found: Array = np.linalg.solve(normal, flat.T @ height)
        return found if float(np.hypot(*found)) > SLIGHT else np.zeros(2)
