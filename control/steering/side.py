"""Commanded sideways speed: different targets for the two feet, with feedback of the speed."""

from collections import deque
from dataclasses import dataclass, field

import numpy as np

from windup.control.pose_graph.gait import Gait
from windup.hal.errors import UsageError
from windup.hal.joints import Array


@dataclass
class SideControl:
    """Computes scalings and targets for a sideways speed.

    Attributes:
        gait: The gait.
        wanted: Commanded speed to the left, m/s.
        present: Ramped speed toward `wanted`, m/s.
        correction: Feedback correction added to `present`, m/s.
    """

    gait: Gait
    wanted: float = 0.0
    present: float = field(default=0.0, init=False)
    correction: float = field(default=0.0, init=False)
    _last: deque[float] = field(default_factory=lambda: deque(maxlen=2), init=False)

    def __post_init__(self) -> None:
        limit = 0.0 if self.gait.file.side is None else self.gait.file.side.limit
        if abs(self.wanted) > limit:
            can = f"walks sideways at most at {limit:g} m/s" if limit else "cannot walk sideways"
            raise UsageError(f"side {self.wanted:g} m/s: gait {self.gait.name!r} {can}")

    def reset(self) -> None:
        """Start over at speed 0."""
        self.present = self.correction = 0.0
        self._last.clear()

    def begin_step(self, wanted: float) -> None:
        """Ramp the speed toward `wanted`, m/s, by one step's change."""
        law = self.gait.file.side
        if law is not None:
            self.wanted = float(np.clip(wanted, -law.limit, law.limit))
            self.present += float(np.clip(self.wanted - self.present, -law.ramp, law.ramp))

    def scale(self) -> Array:
        """Return the (p,) scalings for the present speed."""
        scale = np.zeros(len(self.gait.perturbations))
        law = self.gait.file.side
        if law is not None:
            for name, value in law.scale.items():
                scale[self.gait.index(name)] += value * (self.present + self.correction)
            for name, value in law.spread.items():
                scale[self.gait.index(name)] += value * abs(self.present)
        return scale

    def targets(self, *, swing_is_left: bool) -> dict[str, float]:
        """Return the additions to the targets of a step, by name."""
        law = self.gait.file.side
        speed = (self.present + self.correction) * (1.0 if swing_is_left else -1.0)
        return {} if law is None else {name: v * speed for name, v in law.targets.items()}

    def measured(self, speed: float) -> None:
        """Correct by the sideways speed of the last step, m/s, averaged over a stride (2 steps)."""
        law = self.gait.file.side
        self._last.append(speed)
        if law is not None and len(self._last) == 2:
            change = law.gain * (self.present - float(np.mean(self._last)))
            bound = law.correction
            self.correction = float(np.clip(self.correction + change, -bound, bound))
