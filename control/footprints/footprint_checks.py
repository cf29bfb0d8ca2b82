"""Checks that footprints can be walked: no foot on or across the other, none out of reach."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from shapely import MultiPoint, Polygon
from shapely.affinity import rotate, translate
from shapely.geometry.base import BaseGeometry

from windup.control.footprints.footprints import Footprint
from windup.control.kinematics.limb_ik import LimbIk, Pose
from windup.control.kinematics.places import between, onto, seen_from
from windup.control.kinematics.rotation import turn, turn_between
from windup.hal.errors import UsageError
from windup.hal.joints import Array

CLEAR = 0.004
"""Minimum distance between the soles, m."""
CLOSE, FLAT = 0.002, 0.01
"""Maximum error of the inverse kinematics for a place within reach, m and rad."""
SEARCH = 60
"""Maximum number of iterations of the inverse kinematics."""
STEP = 0.001
"""Step size of the search for a place beside the other foot, m."""


@dataclass(frozen=True)
class FootprintChecks:
    """Checks footprints against the geometry of a robot with two feet.

    Attributes:
        names: Names of the feet.
        limbs: Inverse kinematics of the legs.
        soles: Outlines of the soles in the frames of the soles' centres, m.
        homes: Places (3,) of the feet in the stance, relative to the middle between them.
        stance: (n,) rad, initial guess of the inverse kinematics.
        base: (2,) m, position of the base relative to the centre of mass.
        height: Height of the base above the soles, m.
    """

    names: tuple[str, ...]
    limbs: Sequence[LimbIk]
    soles: Sequence[Polygon]
    homes: Sequence[Array]
    stance: Array
    base: Array
    height: float

    def check(self, prints: Sequence[Footprint]) -> None:
        """Raise if the footprints cannot be walked from the stance, one after the other.

        Raises:
            UsageError: A step cannot be walked; the message has its number, the reason and a
                place that would be right.
        """
        places = list(self.homes)
        for number, one in enumerate(prints, 1):
            try:
                self._one(one, places)
            except UsageError as error:
                where = f"step {number}: " if len(prints) > 1 else ""
                raise UsageError(f"{where}{error}") from None

    def _one(self, one: Footprint, places: list[Array]) -> None:
        """Check one step from `places` (a place for each foot), and update `places`."""
        stance = places[1 - one.foot]
        target = one.place if one.frame == "stance" else seen_from(stance, one.place)
        start = seen_from(stance, places[one.foot])
        self._uncrossed(one.foot, start, target)
        self._reached(one.foot, start, target)
        places[one.foot] = onto(stance, target)

    def side(self, foot: int) -> float:
        """Return 1 if a foot is to the left of the other one, -1 if it is to the right."""
        return float(np.sign(self.homes[foot][1] - self.homes[1 - foot][1]))

    def clear(self, foot: int, target: Array) -> bool:
        """Return True if a foot at `target` (relative to the other one) is clear of that one."""
        there = _at(self.soles[foot], target)
        on_its_side = target[1] * self.side(foot) > 0.0
        return on_its_side and there.distance(self.soles[1 - foot]) > CLEAR

    def _uncrossed(self, foot: int, start: Array, target: Array) -> None:
        name, other = self.names[foot], self.names[1 - foot]
        if not self.clear(foot, target):
            beside = target.copy()
            while not self.clear(foot, beside):
                beside[1] += self.side(foot) * STEP
            raise UsageError(
                f"{name} to {_said(target)} crosses {other} or steps on it; "
                f"{_said(beside)} is beside it"
            )
        way = _at(self.soles[foot], start).union(_at(self.soles[foot], target)).convex_hull
        if way.distance(self.soles[1 - foot]) <= 0.0:
            raise UsageError(
                f"the way of {name} to {_said(target)} crosses {other}; put a step between"
            )

    def _reached(self, foot: int, start: Array, target: Array) -> None:
        if self.within_reach(foot, target):
            return
        part = 0.0
        for k in range(1, 9):
            farther = part + 2.0**-k
            if self.within_reach(foot, start + farther * (target - start)):
                part = farther
        nearest = start + part * (target - start)
        raise UsageError(
            f"{self.names[foot]} does not reach {_said(target)}; {_said(nearest)} is the "
            "farthest on the way there"
        )

    def within_reach(self, foot: int, target: Array) -> bool:
        """Return True if both legs reach their places with the weight over either foot.

        Args:
            foot: Index of the foot that steps.
            target: (3,) its place relative to the other foot.
        """
        feet = [np.zeros(3), target] if foot == 1 else [target, np.zeros(3)]
        yaw = between(np.zeros(3), target)[2]
        for weight in feet:
            place = weight[:2] + turn(yaw)[:2, :2] @ self.base
            base = Pose(np.array([*place, self.height]), turn(yaw))
            if not all(self._can(k, at, base) for k, at in enumerate(feet)):
                return False
        return True

    def _can(self, foot: int, place: Array, base: Pose) -> bool:
        limb, joints = self.limbs[foot], self.stance.copy()
        wanted = Pose(np.array([place[0], place[1], 0.0]), turn(place[2])).seen_from(base)
        joints[limb.joints] = limb.solve(wanted, self.stance, SEARCH)
        found = limb.forward(joints)
        away = np.linalg.norm(found.position - wanted.position)
        tilt = np.linalg.norm(turn_between(found.rotation, wanted.rotation))
        return bool(away < CLOSE and tilt < FLAT)

    def draw(self, count: int, rng: np.random.Generator) -> list[Footprint]:
        """Return random footprints that can be walked, with alternating feet.

        Relative to the stance foot, the other one comes down up to 0.3 `height` ahead or behind,
        to the side between the nearest clear distance and 0.2 `height` more, and turned by up to
        20 degrees.

        Args:
            count: Number of steps.
            rng: Source of the random numbers.
        """
        prints: list[Footprint] = []
        places = list(self.homes)
        while len(prints) < count:
            foot = (len(prints) + 1) % 2
            near = self._nearest(foot)
            side = near + rng.uniform(0.0, 0.2 * self.height)
            forward = rng.uniform(-0.3, 0.3) * self.height
            target = np.array([forward, self.side(foot) * side, np.radians(rng.uniform(-20, 20))])
            try:
                self._one(Footprint(foot, target), places)
            except UsageError:
                continue
            prints.append(Footprint(foot, target))
        return prints

    def _nearest(self, foot: int) -> float:
        """Return the smallest lateral distance of a foot that is clear of the other one, m."""
        beside = np.zeros(3)
        while not self.clear(foot, beside):
            beside[1] += self.side(foot) * STEP
        return abs(float(beside[1]))


def outline(points: Array) -> Polygon:
    """Return the convex outline of points (p, 2) m."""
    hull = MultiPoint(points).convex_hull
    assert isinstance(hull, Polygon), "a sole is a box, or touches in three points or more"
    return hull


def _at(sole: Polygon, place: Array) -> BaseGeometry:
    """Return the outline `sole` moved to a place (3,)."""
    turned = rotate(sole, float(place[2]), origin=(0.0, 0.0), use_radians=True)
    return translate(turned, float(place[0]), float(place[1]))


def _said(place: Array) -> str:
    return f"({place[0]:.3f}, {place[1]:.3f}) m, {np.degrees(place[2]):.0f} degrees"
