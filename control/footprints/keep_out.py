"""Regions of the ground where no sole may come down, such as holes and edges."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from shapely import MultiPoint, Point, Polygon, union_all
from shapely.affinity import rotate, scale, translate
from shapely.geometry.base import BaseGeometry

from windup.control.kinematics.limb_ik import Pose
from windup.control.kinematics.places import between
from windup.control.kinematics.rotation import turn, yaw_of
from windup.hal.errors import UsageError
from windup.hal.joints import Array

FINE = 0.05
"""Change of a sole's heading after which its outline is rotated again, rad."""
PARTS = (0.65, 0.75, 0.85, 0.95, 1.0, 1.1)
"""Fractions of the commanded step at which a foot may really land; OP3's steps fall short."""


class KeepOutRegions:
    """Forbidden regions of the ground, for `step_decision.place`.

    Kenwright 2012, section IV-A.4: a foot must not come down in an undesired location, such as a
    hole.

    Args:
        regions: Polygons relative to the middle between both feet at the start, x forward, m.
        clear: Minimum distance of the soles from a region, m: landings are never exact.

    Attributes:
        here: The regions in the world frame; set by `begin`.
    """

    here: list[BaseGeometry]

    def __init__(self, regions: Sequence[BaseGeometry] = (), clear: float = 0.0) -> None:
        self._regions, self._clear = tuple(regions), clear
        self._kept: tuple[object, list[BaseGeometry]] = (None, [])

    def __bool__(self) -> bool:
        return bool(self._regions)

    def begin(self, feet: Sequence[Pose], soles: Sequence[Array]) -> None:
        """Place the regions in the world, from the two feet at the start.

        Args:
            feet: Poses of the soles' centres in the world.
            soles: Points (p, 3) of each sole in the world, m.

        Raises:
            UsageError: A foot stands in a region.
        """
        yaws = [yaw_of(foot.rotation) for foot in feet]
        places = [np.array([*foot.position[:2], yaw]) for foot, yaw in zip(feet, yaws, strict=True)]
        self.here = [placed(region, between(*places)) for region in self._regions]
        self._outlines = [
            (sole[:, :2] - place[:2]) @ turn(place[2])[:2, :2]
            for sole, place in zip(soles, places, strict=True)
        ]
        self._kept = None, []
        if any(self.covers(sole) for sole in soles):
            raise UsageError("a foot stands on forbidden ground at the start; forbid other ground")

    def covers(self, points: Array) -> bool:
        """Return whether the hull of points (p, 2) or (p, 3) m overlaps a region."""
        hull = MultiPoint(points[:, :2]).convex_hull
        return any(region.intersects(hull) for region in self.here)

    def holes(self, foot: int, yaw: float, start: Array) -> list[BaseGeometry]:
        """Return the forbidden targets of a foot that steps from `start` (2,), heading `yaw` rad.

        With its centre there, or landing short of there, its sole would touch a region.
        """
        if not self._regions:
            return []
        key = (foot, round(yaw / FINE), *np.round(start, 3).tolist())
        if self._kept[0] != key:
            grown = self._grown(foot, yaw)
            self._kept = key, [shadow(hole, start) for hole in grown]
        return self._kept[1]

    def allows(self, foot: int, yaw: float, start: Array, target: Array) -> bool:
        """Return whether a foot may be sent from `start` to `target`, (2,) m; see `holes`."""
        point = Point(target[0], target[1])
        return not any(hole.contains(point) for hole in self.holes(foot, yaw, start))

    def _grown(self, foot: int, yaw: float) -> list[BaseGeometry]:
        """Return the positions of a sole's centre at which it touches a region or its margin."""
        outline = self._outline(foot, yaw)
        return [grown(region, outline, self._clear) for region in self.here]

    def _outline(self, foot: int, yaw: float) -> Array:
        return np.asarray(self._outlines[foot] @ turn(yaw)[:2, :2].T)


def placed(region: BaseGeometry, origin: Array) -> BaseGeometry:
    """Return a region, given relative to `origin` (3,) x m, y m, yaw rad, in the world frame."""
    turned = rotate(region, origin[2], origin=(0.0, 0.0), use_radians=True)
    return translate(turned, origin[0], origin[1])


def grown(region: BaseGeometry, outline: Array, clear: float = 0.0) -> BaseGeometry:
    """Return the positions of a sole's centre at which its `outline` (p, 2) m touches `region`.

    This is the Minkowski sum of the region, widened by `clear` m, and the mirrored outline: the
    region itself, and each of its edges swept over the sole.
    """
    wide = region.buffer(clear, join_style="mitre") if clear else region
    parts = [wide]
    rims = [wide.exterior, *wide.interiors] if isinstance(wide, Polygon) else []
    for rim in rims:
        points = np.asarray(rim.coords)
        for begin, end in pairwise(points):
            swept = np.vstack([begin - outline, end - outline])
            parts.append(MultiPoint(swept).convex_hull)
    return union_all(parts)


def shadow(hole: BaseGeometry, start: Array) -> BaseGeometry:
    """Return the targets from which a foot that starts at `start` (2,) may land in `hole`."""
    origin = (float(start[0]), float(start[1]))
    return union_all([scale(hole, 1.0 / part, 1.0 / part, origin=origin) for part in PARTS])
