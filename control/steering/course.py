"""Holding and changing a course: the wanted heading moves on, and each step turns after it."""

from dataclasses import dataclass, field
from math import copysign, degrees, isfinite, radians, sqrt

import numpy as np

from windup.control.pose_graph.gait_file import Heading, Turn
from windup.control.steering.guide import WalkCommand
from windup.hal.geometry.angles import wrapped

LEAD = radians(30.0)  # farthest that the wanted heading runs ahead of the body


@dataclass
class Course:
    """Scales a turning perturbation: ahead by the rate of turning, and by the heading error.

    Attributes:
        law: Perturbation, gain and limit.
        turn: What turning needs, or None where the gait only holds its course.
        direction: Wanted heading, rad.
        rate: Present turn rate, rad/s.
    """

    law: Heading
    turn: Turn | None = None
    direction: float = 0.0
    rate: float = field(default=0.0, init=False)
    _advance: float = field(default=0.0, init=False)
    _turning: bool = field(default=False, init=False)

    @property
    def perturbation(self) -> str:
        """Name of the perturbation to scale: another one may turn than holds the course."""
        other = self.turn.perturbation if self.turn is not None and self._turning else None
        return other or self.law.perturbation

    def reset(self) -> None:
        """Begin again, straight ahead."""
        self.direction = self.rate = self._advance = 0.0
        self._turning = False

    def begin_step(self, command: WalkCommand, heading: float, duration: float) -> None:
        """Move the wanted heading on by what one step of `duration` s turns."""
        wanted = self._wanted(command, duration)
        self._turning = command.turn != 0.0 or self.rate != 0.0
        ramp = inf_or_radians(self.turn)
        self.rate += float(np.clip(wanted - self.rate, -ramp, ramp))
        self._advance = self.rate * duration
        ahead = wrapped(self.direction + self._advance - heading)
        self.direction = heading + float(np.clip(ahead, -LEAD, LEAD))

    def scale(self, heading: float) -> float:
        """Return the scaling for a base that faces `heading` rad."""
        error = degrees(wrapped(self.direction - heading))
        feed = self.turn.feed * degrees(self._advance) if self.turn is not None else 0.0
        return float(np.clip(feed + self.law.gain * error, -self.law.limit, self.law.limit))

    def _wanted(self, command: WalkCommand, duration: float) -> float:
        """Return the turn rate that the command asks for, rad/s."""
        if command.direction is None:
            rate = command.turn
        else:
            left = wrapped(command.direction - self.direction)
            fast = self._fastest_to_stop(abs(left), max(duration, 1e-3))
            rate = float(np.clip(copysign(fast, left), -abs(command.turn), abs(command.turn)))
        fastest = 0.0 if self.turn is None else radians(self.turn.limit)
        if self.turn is None and command.direction is not None:
            fastest = abs(command.turn)
        return float(np.clip(rate, -fastest, fastest))

    def _fastest_to_stop(self, angle: float, duration: float) -> float:
        """Return the rate from which the ramp comes to rest in `angle` rad and no later, rad/s.

        Going down from k ramps to none turns by k (k + 1) / 2 ramps, one step's worth each.
        """
        ramp = inf_or_radians(self.turn)
        if not isfinite(ramp):
            return angle / duration
        steps = 0.5 * (sqrt(1.0 + 8.0 * angle / (ramp * duration)) - 1.0)
        return min(ramp * steps, angle / duration)


def inf_or_radians(turn: Turn | None) -> float:
    """Return the largest change of the turn rate in a step, rad/s."""
    return float("inf") if turn is None else radians(turn.ramp)
