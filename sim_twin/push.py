"""Pushes: constant forces on a body for a limited time."""

from dataclasses import dataclass

import numpy as np

from windup.hal.joints import Array


@dataclass(frozen=True)
class Push:
    """A horizontal force on one body.

    Attributes:
        body: Name of the body, or "" to push all bodies in proportion to their masses.
        force: (3,) force in the world frame, N.
        start: Time at which the push begins, s.
        duration: Duration, s.
        height: Height of the point of application above the body's frame, m; None is the CoM.
    """

    body: str
    force: Array
    start: float
    duration: float
    height: float | None = None

    @classmethod
    def impulse(
        cls,
        body: str,
        impulse: float,
        direction: float,
        start: float,
        duration: float = 0.1,
        height: float | None = None,
    ) -> "Push":
        """Return a push of `impulse` N s toward `direction` rad (0 forward, positive left)."""
        force = impulse / duration * np.array([np.cos(direction), np.sin(direction), 0.0])
        return cls(body, force, start, duration, height)

    @classmethod
    def velocity_step(
        cls, speed: float, mass: float, direction: float, start: float, duration: float = 0.02
    ) -> "Push":
        """Return a push that gives a robot of `mass` kg `speed` m/s toward `direction` rad."""
        return cls.impulse("", speed * mass, direction, start, duration)

    def active_fraction(self, time: float, step: float) -> float:
        """Return the fraction of the step `time` .. `time + step` s in which the push acts."""
        begin, end = max(self.start, time), min(self.start + self.duration, time + step)
        return max(end - begin, 0.0) / step
