"""Following points and paths: where to turn, how fast to walk, and when to stop.

Laszlo 1996, section 5.3.1: turn in proportion to the angle between the facing direction and the
target point, within a limit. A path is followed by walking to a target point that moves ahead on
it; the thesis' sequence of points is the same with the target points at the corners.
"""

from dataclasses import dataclass, field
from math import atan2, cos, pi

import numpy as np

from windup.control.steering.guide import Place, WalkCommand
from windup.hal.errors import UsageError
from windup.hal.geometry.angles import wrapped
from windup.hal.joints import Array

BRAKE = 0.4  # speed per distance to the goal, 1/s
CREEP = 0.03  # minimum speed of approach, m/s


@dataclass(frozen=True)
class Agility:
    """Limits of a gait on a path.

    Attributes:
        speed: Desired speed, m/s, or None for the gait's default.
        turn: Maximum turn rate, rad/s.
        radius: Minimum turning radius at speed, m; 0 for a robot that turns on the spot.
        slow: Minimum speed in a turn, m/s; None to keep `speed` in turns.
    """

    speed: float | None
    turn: float
    radius: float = 0.0
    slow: float | None = None

    def speed_for(self, angle: float) -> float | None:
        """Return the speed toward a target at `angle` rad from straight ahead, m/s, or None."""
        fast, slow = self.speed, self.slow
        if fast is None or slow is None:
            return fast
        return max(slow, fast * max(0.0, cos(min(2.0 * abs(angle), 0.5 * pi))))


@dataclass
class PathFollower:
    """Guide that walks along a polyline and stops at its end.

    Attributes:
        points: (p, 2) corners, m.
        agility: Limits of the gait.
        look_ahead: Distance of the target point ahead on the path, m.
        closed: The path returns from the last point to the first, and ends there.
        along: Distance covered along the path, m.
        done: The end has been reached.
    """

    points: Array
    agility: Agility
    look_ahead: float = 0.5
    closed: bool = False
    along: float = field(default=0.0, init=False)
    done: bool = field(default=False, init=False)

    def __post_init__(self) -> None:
        self.points = checked(self.points, self.agility, closed=self.closed)
        ways = np.linalg.norm(np.diff(self._corners(), axis=0), axis=1)
        self._at = np.concatenate([[0.0], np.cumsum(ways)])

    @property
    def length(self) -> float:
        """Length of the path, m."""
        return float(self._at[-1])

    def point(self, along: float) -> Array:
        """Return the point (2,) at a distance along the path; an open end is extended straight."""
        corners = self._corners()
        if self.closed:
            along %= self.length
        if along > self.length:
            last = corners[-1] - corners[-2]
            beyond: Array = corners[-1] + last / np.linalg.norm(last) * (along - self.length)
            return beyond
        return np.array([np.interp(along, self._at, corners[:, axis]) for axis in (0, 1)])

    def command(self, place: Place) -> WalkCommand:
        """Return the command for the step that begins at `place`."""
        self._advance(place)
        if self.done:
            return WalkCommand(stop=True, turn=self.agility.turn, direction=place.heading)
        ahead = self.point(self.along + self.look_ahead) - place.position
        direction = atan2(ahead[1], ahead[0])
        return WalkCommand(
            speed=self.agility.speed_for(wrapped(direction - place.heading)),
            turn=self.agility.turn,
            direction=direction,
        )

    def passed(self, way: Array) -> Array:
        """Return the minimum distance (p,) of a walked track (t, 2) from each corner, m."""
        distances = np.linalg.norm(way[:, None] - self.points[None], axis=2)
        return np.asarray(distances.min(axis=0))

    def _advance(self, place: Place) -> None:
        """Advance `along` to the point of the path nearest to the robot, never back."""
        window = self.along + np.linspace(0.0, 1.5 * self.look_ahead, 61)
        if not self.closed:
            window = np.minimum(window, self.length)
        near = np.array([np.hypot(*(self.point(s) - place.position)) for s in window])
        self.along = float(window[near.argmin()])
        self.done |= self.along >= self.length - (0.0 if self.closed else 0.3 * self.look_ahead)

    def _corners(self) -> Array:
        return np.vstack([self.points, self.points[:1]]) if self.closed else self.points


@dataclass
class PointFollower:
    """Guide that walks to a point and stops there.

    Attributes:
        point: (2,) m.
        agility: Limits of the gait.
        near: Maximum distance at which the point counts as reached, m.
        done: The point has been reached.
    """

    point: Array
    agility: Agility
    near: float = 0.1
    done: bool = field(default=False, init=False)

    def command(self, place: Place) -> WalkCommand:
        """Return the command for the step that begins at `place`."""
        ahead = self.point - place.position
        self.done |= float(np.hypot(*ahead)) <= self.near
        if self.done:
            return WalkCommand(stop=True, turn=self.agility.turn, direction=place.heading)
        direction = atan2(ahead[1], ahead[0])
        speed = self.agility.speed_for(wrapped(direction - place.heading))
        if speed is not None and self.agility.slow is not None:
            speed = min(speed, max(self.agility.slow, BRAKE * float(np.hypot(*ahead)), CREEP))
        return WalkCommand(speed=speed, turn=self.agility.turn, direction=direction)

    def passed(self, way: Array) -> Array:
        """Return the minimum distance (1,) of a walked track (t, 2) from the point, m."""
        return np.array([np.linalg.norm(way - self.point, axis=1).min()])


def checked(points: Array, agility: Agility, *, closed: bool) -> Array:
    """Return the points of a path without repetitions, if a gait can follow it.

    A corner that turns by an angle needs a length of ``radius tan(angle / 2)`` on each of its two
    legs; each corner may use half of a leg.

    Raises:
        UsageError: The path has fewer than two different points, or a corner is too tight.
    """
    points = np.asarray(points, dtype=float).reshape(-1, 2)
    new = np.concatenate([[True], np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-6])
    points = points[new]
    if len(points) < 2:
        raise UsageError("a path needs two different points")
    legs = np.diff(np.vstack([points, points[:2]]) if closed else points, axis=0)
    for i in range(len(legs) - 1):
        room = 0.5 * float(min(np.linalg.norm(legs[i]), np.linalg.norm(legs[i + 1])))
        bends = [atan2(leg[1], leg[0]) for leg in legs[i : i + 2]]
        angle = abs(wrapped(bends[1] - bends[0]))
        needed = agility.radius * float(np.tan(min(0.5 * angle, 1.55)))
        if needed > room:
            x, y = points[(i + 1) % len(points)]
            raise UsageError(
                f"the corner at ({x:g}, {y:g}) is too tight: {np.degrees(angle):.0f} degrees need "
                f"legs of {2.0 * needed:.2g} m, and there are {2.0 * room:.2g} m"
            )
    return points


def circle(radius: float, points: int = 72) -> Array:
    """Return points (p, 2) of a left-hand circle that begins at the origin, straight ahead."""
    angle = 2.0 * pi * np.arange(points) / points
    return radius * np.stack([np.sin(angle), 1.0 - np.cos(angle)], axis=1)


def square(side: float) -> Array:
    """Return corners (4, 2) of a left-hand square that begins at the origin, straight ahead."""
    return side * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
