"""Walking with an inverted pendulum: footsteps for a commanded velocity, and the capture point.

Kenwright 2012, section V: it "can predict where to move the feet to maintain a persistent stable
walking motion or to halt movement in any direction". At constant height the capture point xi
diverges from the centre of pressure p, ``xi' = omega (xi - p)``, and the CoM x follows it,
``x' = omega (xi - x)``. So the trajectory of xi is integrated backward from its end.

Places are (x m, y m, yaw rad) on the ground.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, exp, sin

import numpy as np

from windup.control.kinematics.places import onto, seen_from
from windup.control.kinematics.rotation import way_round
from windup.hal.joints import Array


@dataclass(frozen=True)
class VelocityCommand:
    """Commanded velocity of a walk.

    Attributes:
        speed: Speed, m/s; 0 halts the robot.
        heading: Direction of motion in the plan's frame, rad.
        face: Heading of the trunk in the plan's frame, rad.
    """

    speed: float = 0.0
    heading: float = 0.0
    face: float = 0.0


@dataclass(frozen=True)
class StepTiming:
    """Timing and bounds of the steps.

    Attributes:
        single: Duration of single support, s.
        double: Duration of double support, s.
        width: Nominal lateral distance of the feet, m.
        longest: Maximum forward or backward distance of the feet, m.
        narrowest: Minimum lateral distance of the feet, m.
        widest: Maximum lateral distance of the feet, m.
        turn: Maximum yaw between the feet, rad.
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
        """Duration of a step, single and double support, s."""
        return self.single + self.double


def next_place(stance: Array, foot: int, order: VelocityCommand, pace: StepTiming) -> Array:
    """Return the next place (3,) of `foot` (0 left), with the other one at `stance` (3,).

    It is displaced from its nominal place by the body's motion in a step, within the bounds.
    """
    left = way_round(stance[2], order.face)
    # A foot turns only outward (the left one to the left); the other one follows in the next step.
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
    """A linear segment of the trajectory of the centre of pressure.

    Attributes:
        begin: (2,) start point, m.
        end: (2,) end point, m.
        duration: Duration, s.
    """

    begin: Array
    end: Array
    duration: float

    def pressure(self, time: float) -> Array:
        """Return the centre of pressure (2,) m at `time`, s after the start of the segment."""
        part = min(time / self.duration, 1.0)
        return np.asarray(self.begin + part * (self.end - self.begin))


def capture_on_way(way: Sequence[PressureSegment], omega: float, time: float) -> Array:
    """Return the capture point (2,) m on a CoP trajectory that ends at rest.

    Args:
        way: The trajectory from the present segment on.
        omega: Natural frequency of the pendulum, 1/s.
        time: Time since the start of the present segment, s.
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
    """Return the CoP trajectory after the present swing, which ends at rest.

    Args:
        stance: (3,) place of the stance foot.
        foot: Index of the swing foot.
        landing: (3,) landing place of the swing foot.
        order: Commanded velocity of the further steps.
        pace: Timing and bounds of the steps.
        steps: Number of further steps.
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
