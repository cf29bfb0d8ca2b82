"""Course control: the desired heading advances at the turn rate, and each step turns toward it."""

from dataclasses import dataclass, field
from math import copysign, degrees, isfinite, radians, sqrt

import numpy as np

from windup.control.pose_graph.gait_file import Heading, Turn
from windup.control.steering.guide import WalkCommand
from windup.hal.geometry.angles import wrapped

LEAD = radians(30.0)  # maximum lead of the desired heading over the measured one


@dataclass
class Course:
    """Scales a turning perturbation: feedforward of the turn rate, feedback of the heading error.

    Attributes:
        law: The `heading` table of the gait: perturbation, gain and limit.
        turn: The `turn` table of the gait, or None if the gait only holds its course.
        direction: Desired heading, rad.
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
        """Name of the perturbation to scale; turning may use another one than holding a course."""
        other = self.turn.perturbation if self.turn is not None and self._turning else None
        return other or self.law.perturbation

    def reset(self) -> None:
        """Start over with desired heading 0 and turn rate 0."""
        self.direction = self.rate = self._advance = 0.0
        self._turning = False

    def begin_step(self, command: WalkCommand, heading: float, duration: float) -> None:
        """Advance the desired heading by the turn of one step of `duration` s."""
        wanted = self._wanted(command, duration)
        self._turning = command.turn != 0.0 or self.rate != 0.0
        ramp = inf_or_radians(self.turn)
        self.rate += float(np.clip(wanted - self.rate, -ramp, ramp))
        self._advance = self.rate * duration
        ahead = wrapped(self.direction + self._advance - heading)
        self.direction = heading + float(np.clip(ahead, -LEAD, LEAD))

    def scale(self, heading: float) -> float:
        """Return the scaling for a base with a measured `heading`, rad."""
        error = degrees(wrapped(self.direction - heading))
        feed = self.turn.feed * degrees(self._advance) if self.turn is not None else 0.0
        return float(np.clip(feed + self.law.gain * error, -self.law.limit, self.law.limit))

    def _wanted(self, command: WalkCommand, duration: float) -> float:
        """Return the commanded turn rate within the gait's limit, rad/s."""
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
        """Return the largest turn rate that can still be ramped to 0 within `angle` rad, rad/s.

        Ramping down from k ramps to 0 turns by k (k + 1) / 2 times the ramp times the duration.
        """
        ramp = inf_or_radians(self.turn)
        if not isfinite(ramp):
            return angle / duration
        steps = 0.5 * (sqrt(1.0 + 8.0 * angle / (ramp * duration)) - 1.0)
        return min(ramp * steps, angle / duration)


def inf_or_radians(turn: Turn | None) -> float:
    """Return the maximum change of the turn rate per step, rad/s; infinite without a table."""
    return float("inf") if turn is None else radians(turn.ramp)
