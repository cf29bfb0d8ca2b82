"""The profile of a goal: the trajectory from the present position to the goal."""

import math
from typing import NamedTuple

STEP, RECTANGULAR, TRIANGULAR, TRAPEZOIDAL = 0, 1, 2, 3


class Phase(NamedTuple):
    """A phase of constant acceleration.

    Attributes:
        seconds: Duration, s.
        position: Position at its start, in the profile's unit.
        velocity: Velocity at its start, unit/s.
        acceleration: Acceleration, unit/s2.
    """

    seconds: float
    position: float
    velocity: float
    acceleration: float


class Profile:
    """A trapezoidal velocity profile from a moving start to a goal at rest, in any unit.

    Args:
        start: Initial position.
        velocity: Initial velocity.
        goal: Final position.
        top: Largest velocity; 0 means unlimited: the goal is a step.
        acceleration: Largest acceleration; 0 means unlimited: the profile is a rectangle.

    Attributes:
        goal: Final position.
        kind: STEP, RECTANGULAR, TRIANGULAR or TRAPEZOIDAL, as in Moving Status.
        duration: Duration, s.
    """

    def __init__(
        self, start: float, velocity: float, goal: float, top: float, acceleration: float
    ) -> None:
        self.goal = goal
        self.kind = STEP
        self.duration = 0.0
        self._phases: list[Phase] = []
        self._end = start
        if top > 0.0 and start != goal:
            if acceleration > 0.0:
                self._trapezoid(velocity, goal, top, acceleration)
            else:
                self.kind = RECTANGULAR
                self._add(abs(goal - start) / top, math.copysign(top, goal - start), 0.0)

    @classmethod
    def timed(cls, start: float, goal: float, seconds: float, rise: float) -> "Profile":
        """Return a profile of duration `seconds` that reaches its top velocity in `rise` s."""
        rise = min(rise, 0.5 * seconds)
        top = abs(goal - start) / (seconds - rise) if seconds > 0.0 else 0.0
        return cls(start, 0.0, goal, top, top / rise if rise > 0.0 else 0.0)

    def state_at(self, time: float) -> tuple[float, float]:
        """Return position and velocity `time` s after the start."""
        for phase in self._phases:
            if time < phase.seconds:
                gained = phase.acceleration * time
                return (
                    phase.position + (phase.velocity + 0.5 * gained) * time,
                    phase.velocity + gained,
                )
            time -= phase.seconds
        return self.goal, 0.0

    def _trapezoid(self, velocity: float, goal: float, top: float, acceleration: float) -> None:
        self.kind = TRAPEZOIDAL
        stop = self._end + 0.5 * velocity * abs(velocity) / acceleration
        way = 1.0 if goal >= stop else -1.0
        if velocity * way < 0.0:  # moving away: brake first
            self._add(abs(velocity) / acceleration, velocity, way * acceleration)
            velocity = 0.0
        speed, distance = abs(velocity), way * (goal - self._end)
        peak = math.sqrt(max(0.5 * speed * speed + acceleration * distance, 0.0))
        if peak <= top:
            self.kind, top = TRIANGULAR, peak
        rate = acceleration if top >= speed else -acceleration
        self._add((top - speed) / rate, way * speed, way * rate)
        left = way * (goal - self._end) - 0.5 * top * top / acceleration
        if top > 0.0:
            self._add(max(left, 0.0) / top, way * top, 0.0)
        self._add(top / acceleration, way * top, -way * acceleration)

    def _add(self, seconds: float, velocity: float, acceleration: float) -> None:
        if seconds > 0.0:
            self._phases.append(Phase(seconds, self._end, velocity, acceleration))
            self.duration += seconds
            self._end += (velocity + 0.5 * acceleration * seconds) * seconds
