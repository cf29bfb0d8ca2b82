"""The inverted pendulum that walks: where feet go for a wanted velocity, and the weight with them.

Kenwright 2012, section V: it "can predict where to move the feet to maintain a persistent stable
walking motion or to halt movement in any direction". At constant height its capture point xi runs
away from the centre of pressure p, ``xi' = omega (xi - p)``, and the weight x follows it,
``x' = omega (xi - x)``. So the way of xi is found backward from where it shall end.

Places are (x m, y m, yaw rad) on the ground.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, exp, sin

import numpy as np

from windup.control.footprints.footprints import onto, seen_from
from windup.control.kinematics.rotation import way_round
from windup.hal.joints import Array


@dataclass(frozen=True)
class VelocityCommand:
    """Where somebody wants a robot to walk.

    Attributes:
        speed: m/s; 0 halts it.
        heading: Where to, rad, in the world of the plan.
        face: Where its trunk looks, rad.
    """

    speed: float = 0.0
    heading: float = 0.0
    face: float = 0.0


@dataclass(frozen=True)
class StepTiming:
    """What steps a robot takes.

    Attributes:
        single: Time on one foot, s.
        double: Time on both, s.
        width: From one foot to the other beside it, m.
        longest: Farthest before or behind it, m.
        narrowest: Nearest beside it, m.
        widest: Farthest beside it, m.
        turn: Most that a foot is turned against the other one, rad.
    """

    single: float
    double: float
    width: float
    longest: float
    narrowest: float
    widest: float
    turn: float

    @property
    def period(self) -> float:
        """From one step to the next, s."""
        return self.single + self.double


def next_place(stance: Array, foot: int, order: VelocityCommand, pace: StepTiming) -> Array:
    """Return where (3,) `foot` (0 left) goes from beside the other one, at `stance` (3,).

    As far from there as the body goes in the time of a step, and no farther than it reaches.
    """
    left = way_round(stance[2], order.face)
    # The foot that is outside turns first; the other one follows it with the next step.
    turned = float(np.clip(left, *((0.0, pace.turn) if foot == 0 else (-pace.turn, 0.0))))
    way = order.speed * pace.period * np.array([cos(order.heading), sin(order.heading), 0.0])
    ahead = seen_from(np.array([0.0, 0.0, stance[2] + 0.5 * turned]), way)
    side = 1 - 2 * foot
    aside = side * float(np.clip(pace.width + side * ahead[1], pace.narrowest, pace.widest))
    forward = float(np.clip(ahead[0], -pace.longest, pace.longest))
    half = onto(stance, np.array([0.0, 0.0, 0.5 * turned]))
    return onto(half, np.array([forward, aside, 0.5 * turned]))


@dataclass(frozen=True)
class PressureSegment:
    """A stretch of the way of the centre of pressure.

    Attributes:
        begin: (2,) m.
        end: (2,) m.
        duration: s.
    """

    begin: Array
    end: Array
    duration: float

    def pressure(self, time: float) -> Array:
        """Return where (2,) it is `time` s after the beginning."""
        part = min(time / self.duration, 1.0)
        return np.asarray(self.begin + part * (self.end - self.begin))


def capture_on_way(way: Sequence[PressureSegment], omega: float, time: float) -> Array:
    """Return where (2,) the capture point is on a way of the pressure that ends in rest.

    Args:
        way: What is left of it, from the present stretch on.
        omega: Rate of the pendulum, 1/s.
        time: How far into the present stretch, s.
    """
    point = way[-1].end
    for number in range(len(way) - 1, -1, -1):
        stretch = way[number]
        begin = min(time, stretch.duration) if number == 0 else 0.0
        pace = (stretch.end - stretch.begin) / stretch.duration / omega
        away = (point - stretch.end - pace) * exp(-omega * (stretch.duration - begin))
        point = stretch.pressure(begin) + pace + away
    return np.asarray(point)


def future(
    stance: Array, foot: int, landing: Array, order: VelocityCommand, pace: StepTiming, steps: int
) -> list[PressureSegment]:
    """Return the way of the pressure after the present swing, which ends in rest.

    Args:
        stance: (3,) the foot that bears.
        foot: The other one, in the air.
        landing: (3,) where it comes down.
        order: Where to walk after that.
        pace: How.
        steps: How many steps are looked ahead.
    """
    way = []
    for _ in range(steps):
        way += [
            PressureSegment(stance[:2], landing[:2], pace.double),
            PressureSegment(landing[:2], landing[:2], pace.single),
        ]
        foot = 1 - foot
        stance, landing = landing, next_place(landing, foot, order, pace)
    return [*way, PressureSegment(stance[:2], 0.5 * (stance[:2] + landing[:2]), pace.period)]
