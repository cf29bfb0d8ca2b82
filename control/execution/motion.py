"""Planned motions of a robot on two feet: the path of its weight, and one foot in the air.

Wu & Zordan 2010, section 5: two curves of time say what the CoM and the swing foot do. Whoever
decides on steps writes a motion; an executor realises it.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import cos, pi, sqrt
from typing import Literal

import numpy as np

from windup.control.execution.swing import bezier, gaussian_progress, lift
from windup.control.kinematics.rotation import heading_between
from windup.hal.geometry.angles import wrapped
from windup.hal.joints import Array

PEAK = 5.77
"""Peak acceleration of `swing.smooth_progress`, for a path of length 1 in time 1."""


@dataclass(frozen=True)
class Planted:
    """Places at which two feet are to stay.

    Attributes:
        places: (2, 3) positions of the soles' centres, on the ground, m.
        yaws: (2,) headings of the soles, rad.
    """

    places: Array
    yaws: Array

    @property
    def front(self) -> float:
        """Mean heading of the feet, rad."""
        return heading_between(self.yaws[0], self.yaws[1], 0.5)

    def step(self, foot: int, place: Array, yaw: float) -> "Planted":
        """Return a copy with one foot at another place (2,) or (3,), m, and heading, rad."""
        places, yaws = self.places.copy(), self.yaws.copy()
        places[foot, :2], yaws[foot] = place[:2], yaw
        return Planted(places, yaws)


@dataclass
class Shift:
    """Path of the weight on the ground, as a function of time alone.

    Attributes:
        start: (2,) start, m.
        goal: (2,) end, m; it stays there.
        began: Time of the start, s.
        seconds: Duration, s.
        ease: Returns the fraction of the path done at a fraction of the time.
        via: (2,) middle control point of a Bezier curve, m; None for a straight path. A curve has
            an ease of its own (section 5.2).
        smooth: The acceleration of the path is continuous, so it may be fed forward.
    """

    start: Array
    goal: Array
    began: float
    seconds: float
    ease: Callable[[float], float]
    via: Array | None = None
    smooth: bool = False

    def part(self, time: float) -> float:
        """Return the fraction of the duration that is over, at most 1."""
        return min((time - self.began) / self.seconds, 1.0)

    def at(self, time: float) -> Array:
        """Return the point (2,) of the path, m."""
        part = self.part(time)
        if self.via is not None:
            return bezier(self.start, self.via, self.goal, part)
        return np.asarray(self.start + self.ease(part) * (self.goal - self.start))


def shift_time(far: float, least: float, pace: float) -> float:
    """Return the duration of a quintic path of `far` m, s.

    Args:
        far: Length, m.
        least: Minimum duration, s.
        pace: Maximum acceleration, m/s2.
    """
    return max(least, sqrt(PEAK * far / pace))


def cosine_progress(part: float) -> float:
    """Return the fraction of a path that is done at the time fraction `part`, eased in and out."""
    return 0.5 * (1.0 - cos(pi * min(part, 1.0)))


@dataclass
class Swing:
    """One foot (or hand) in the air.

    Attributes:
        foot: Index of the foot.
        began: Start time, s.
        duration: Planned duration, s.
        start: (3,) position of the sole at the start, m.
        target: (2,) target of the sole, m.
        yaw: Headings of the sole at the start and at the target, rad.
        height: Height to which the foot is lifted, m.
        anchor: (2,) where the executor held the weight at the start, m; see `Executor.anchor`.
    """

    foot: int
    began: float
    duration: float
    start: Array
    target: Array
    yaw: tuple[float, float]
    height: float
    anchor: Array

    def part(self, time: float) -> float:
        """Return the fraction of the duration that is over; more than 1 when it is late."""
        return (time - self.began) / self.duration

    def at(self, time: float) -> tuple[Array, float]:
        """Return the desired position (3,) of the sole, m, and its heading, rad (section 5.1)."""
        part = self.part(time)
        way = gaussian_progress(part)
        at = self.start.copy()
        at[:2] += way * (self.target - self.start[:2])
        at[2] = (1.0 - way) * self.start[2] + lift(part, self.height)
        at[2] -= max(part - 1.0, 0.0) * self.height  # then further down until contact
        return at, self.yaw[0] + way * wrapped(self.yaw[1] - self.yaw[0])


@dataclass
class Motion:
    """What a robot on two feet should do.

    Attributes:
        planted: Places at which the feet on the ground are to stay.
        shift: Path of the weight.
        swing: The foot in the air, or None.
        landed: Time of the last touchdown of a step that prevents a fall, s; -inf before any.
        yaw: Headings of the base at the start and the end of the shift, rad, where the weight
            follows its path exactly and the robot is not in danger of falling; None where it may
            be: then the executor balances.
    """

    planted: Planted
    shift: Shift
    swing: Swing | None = None
    landed: float = -np.inf
    yaw: tuple[float, float] | None = None


WalkPhase = Literal["rest", "shift", "swing", "land"]


@dataclass
class WalkMotion(Motion):
    """One phase of a slow step to a footprint; what it adds is needed by position servos only.

    Attributes:
        phase: The weight shifts between the feet (rest) or over the stance foot (shift), the other
            foot swings, or it takes its load (land).
        foot: Index of the foot that steps.
        left: (3,) place of that foot at the start of its swing, relative to the stance foot.
        target: (3,) its footprint, relative to the stance foot.
        height: Heights of the base above the ground at the start and the end of the phase, m.
        load: Shares of the weight on the second foot at the start and the end of the phase.
        apart: (3,) place of the second foot relative to the first, as they came down.
    """

    phase: WalkPhase = "rest"
    foot: int = 0
    left: Array = field(default_factory=lambda: np.zeros(3))
    target: Array = field(default_factory=lambda: np.zeros(3))
    height: tuple[float, float] = (0.0, 0.0)
    load: tuple[float, float] = (0.5, 0.5)
    apart: Array = field(default_factory=lambda: np.zeros(3))
